// Splits a network file into pieces with different colours. It is a simple scanner and not a TOML
// parser, so incomplete text is coloured too.

export interface Ink {
  kind: 'remark' | 'heading' | 'string' | 'number' | 'plain'
  text: string
}

const PIECES =
  /(?<remark>#[^\n]*)|(?<heading>^[ \t]*\[\[?[^\]\n]*\]\]?)|(?<string>"(?:[^"\\\n]|\\.)*"?|'[^'\n]*'?)|(?<number>(?<![\w.-])[+-]?\d[\d_.:eE+-]*|\b(?:true|false)\b)/gm

/** The text in order, with nothing left out. */
export function coloured(text: string): Ink[] {
  const inks: Ink[] = []
  let end = 0
  for (const match of text.matchAll(PIECES)) {
    if (match.index > end) inks.push({ kind: 'plain', text: text.slice(end, match.index) })
    const kind = (['remark', 'heading', 'string', 'number'] as const).find(
      (one) => match.groups?.[one] !== undefined,
    )
    inks.push({ kind: kind ?? 'plain', text: match[0] })
    end = match.index + match[0].length
  }
  if (end < text.length) inks.push({ kind: 'plain', text: text.slice(end) })
  return inks
}
