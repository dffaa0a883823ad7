// Values as TOML writes them, as a person would: one line where it is short, a row a line where it is a table of numbers.

export type Literal =
  string | number | boolean | readonly Literal[] | { readonly [member: string]: Literal | undefined }

/** Lists that would be longer are broken. */
const LONGEST_LINE = 100
const INDENT = '    '

/** A value in a file. */
export function literal(value: Literal, newline = '\n'): string {
  if (typeof value === 'string') return quoted(value)
  if (typeof value === 'number') return number(value)
  if (typeof value === 'boolean') return String(value)
  if (isList(value)) return list(value, newline)
  return `{ ${pairs(value).join(', ')} }`
}

/** The lines of a table's members. */
export function lines(table: Readonly<Record<string, Literal | undefined>>, newline = '\n'): string[] {
  return pairs(table, newline)
}

/** A key, in quotes where it needs them. */
export function key(name: string): string {
  return /^[A-Za-z0-9_-]+$/.test(name) ? name : quoted(name)
}

function pairs(table: Readonly<Record<string, Literal | undefined>>, newline = '\n'): string[] {
  return Object.entries(table).flatMap(([name, value]) =>
    value === undefined ? [] : [`${key(name)} = ${literal(value, newline)}`],
  )
}

/** The shortest text that reads as the same number; never with an exponent, which is unusual in such a file. */
function number(value: number): string {
  const text = String(value)
  return text.includes('e') ? value.toFixed(20).replace(/\.?0+$/, '') : text
}

function quoted(text: string): string {
  const escaped = text.replace(/["\\\p{Cc}]/gu, (character) => {
    if (character === '"' || character === '\\') return `\\${character}`
    return `\\u${character.charCodeAt(0).toString(16).padStart(4, '0')}`
  })
  return `"${escaped}"`
}

function list(values: readonly Literal[], newline: string): string {
  const texts = values.map((value) => literal(value, newline))
  const onOneLine = `[${texts.join(', ')}]`
  const hasRows = values.some((value) => typeof value === 'object')
  if (values.length === 0 || (!hasRows && onOneLine.length <= LONGEST_LINE)) return onOneLine
  const broken = hasRows ? texts : filled(texts)
  return `[${newline}${broken.map((line) => `${INDENT}${line},${newline}`).join('')}]`
}

/** Texts joined into lines that are as full as may be. */
function filled(texts: string[]): string[] {
  const full: string[] = []
  for (const text of texts) {
    const last = full.at(-1)
    if (last !== undefined && INDENT.length + last.length + text.length + 3 <= LONGEST_LINE) {
      full[full.length - 1] = `${last}, ${text}`
    } else full.push(text)
  }
  return full
}

function isList(value: Literal): value is readonly Literal[] {
  return Array.isArray(value)
}
