// Formats TOML values as a person would write them: short values on one line, tables of numbers
// with one row per line.

export type Literal =
  string | number | boolean | readonly Literal[] | { readonly [member: string]: Literal | undefined }

/** Longer lists are broken into lines. */
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

/** A key, quoted if necessary. */
export function key(name: string): string {
  return /^[A-Za-z0-9_-]+$/.test(name) ? name : quoted(name)
}

function pairs(table: Readonly<Record<string, Literal | undefined>>, newline = '\n'): string[] {
  return Object.entries(table).flatMap(([name, value]) =>
    value === undefined ? [] : [`${key(name)} = ${literal(value, newline)}`],
  )
}

/**
 * The shortest text that parses to the same number. It never has an exponent, which is unusual in
 * such files.
 */
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

/** Joins texts into lines that are as full as possible. */
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
