// A network file in pieces that are shown in different colours. It reads letters and not TOML, so that a text that is being typed has
// colours too.

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
