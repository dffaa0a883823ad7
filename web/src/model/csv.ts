// Reads CSV as the program writes it: commas, any line endings, and quotes around fields that
// contain commas or quotes.

/** The rows of a table, each a list of its fields. An empty line is no row. */
export function parseCsv(text: string): string[][] {
  const rows: string[][] = []
  const plain = text.replace(/^\uFEFF/, '')
  let at = 0
  while (at < plain.length) {
    const { row, next } =
      plain[at] === '"' || hasQuoteBeforeLineEnd(plain, at) ? quotedRow(plain, at) : plainRow(plain, at)
    if (row.length > 1 || row[0] !== '') rows.push(row)
    at = next
  }
  return rows
}

interface Row {
  row: string[]
  next: number
}

function hasQuoteBeforeLineEnd(text: string, at: number): boolean {
  const quote = text.indexOf('"', at)
  return quote !== -1 && quote < lineEnd(text, at)
}

function lineEnd(text: string, at: number): number {
  const end = text.indexOf('\n', at)
  return end === -1 ? text.length : end
}

function plainRow(text: string, at: number): Row {
  const end = lineEnd(text, at)
  return { row: text.slice(at, end).replace(/\r$/, '').split(','), next: end + 1 }
}

/**
 * A row with quoted fields. A quote inside is doubled, and a quoted field may contain line endings.
 */
function quotedRow(text: string, begin: number): Row {
  const row: string[] = []
  let [at, field, isQuoted] = [begin, '', false]
  for (; at < text.length; at++) {
    const letter = text.charAt(at)
    if (isQuoted) {
      if (letter !== '"') field += letter
      else if (text[at + 1] === '"') field += text.charAt(at++)
      else isQuoted = false
    } else if (letter === '"') isQuoted = true
    else if (letter === ',') {
      row.push(field)
      field = ''
    } else if (letter === '\n') break
    else if (letter !== '\r') field += letter
  }
  row.push(field)
  return { row, next: at + 1 }
}
