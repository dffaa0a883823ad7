// Changes to a file as text edits, so that everything else stays the same to the last space. The
// edits of several changes refer to the same text and are applied together.

import { key, lines, literal, type Literal } from './literals'
import { beginsWith, keysOf, spanOf, type Content, type Pair, type Path, type Table, TomlFile } from './toml'

/** A part of the text, and its replacement. */
export interface Splice {
  from: number
  to: number
  text: string
}

/** The members of a new table, in the order in which they are written. */
export type Members = Readonly<Record<string, Literal | undefined>>

/** The text after edits that all refer to the text before. */
export function apply(text: string, splices: readonly Splice[]): string {
  const ordered = [...splices].sort((one, other) => one.from - other.from || one.to - other.to)
  let [made, end] = ['', 0]
  for (const { from, to, text: piece } of ordered) {
    if (from < end) throw new Error('changes of one file must not overlap')
    made += text.slice(end, from) + piece
    end = to
  }
  return made + text.slice(end)
}

/** Sets a member to a value, whether or not it exists. */
export function set(file: TomlFile, path: Path, value: Literal): Splice[] {
  const found = file.find(path)
  if (found !== undefined && 'value' in found) return replaced(file, found.value, value)
  const [parent, name] = [path.slice(0, -1), path.at(-1)]
  if (typeof name !== 'string') throw new Error(`there is no entry ${path.join('.')}`)
  const holder = file.find(parent)
  if (holder !== undefined && 'value' in holder) return intoInlineTable(holder.value, name, value)
  const line = `${key(name)} = ${literal(value, newlineOf(file))}`
  if (holder !== undefined) return [behind(file, holder.table.body.at(-1) ?? headingOf(holder.table), line)]
  return [intoDotted(file, parent, name, value) ?? intoRoot(file, parent, line)]
}

/** Removes a member, a table with all of its members, or an entry of a list. */
export function remove(file: TomlFile, path: Path): Splice[] {
  const found = file.find(path)
  const index = path.at(-1)
  if (found !== undefined && 'value' in found && typeof index === 'number') {
    const list = file.find(path.slice(0, -1))
    return list !== undefined && 'value' in list ? [withoutElement(list.value, index)] : []
  }
  if (found !== undefined && 'value' in found)
    return found.pair === undefined ? [] : withoutPair(file, found.pair)
  const tables = file.tables.filter(({ resolvedKey }) => beginsWith(resolvedKey, path))
  return tables.map((table) => withoutTable(file, table))
}

/** Adds an entry to a list, which may have a heading per entry or brackets. */
export function append(file: TomlFile, path: Path, entry: Literal | Members): Splice[] {
  const found = file.find(path)
  if (found !== undefined && 'value' in found && found.value.type === 'TOMLArray')
    return [withElement(file, found.value, entry)]
  const newline = newlineOf(file)
  const block = [
    `[[${path.map((step) => key(String(step))).join('.')}]]`,
    ...lines(entry as Members, newline),
  ]
  const last = file.tables.findLast(({ resolvedKey }) => beginsWith(resolvedKey, path))
  return [blockBehind(file, last, block)]
}

/** Adds a table with a heading after another one, or at the end. */
export function addTable(file: TomlFile, path: Path, members: Members, after: Path = []): Splice[] {
  const heading = `[${path.map((step) => key(String(step))).join('.')}]`
  const last =
    after.length === 0 ? undefined : file.tables.findLast(({ resolvedKey }) => beginsWith(resolvedKey, after))
  return [blockBehind(file, last, [heading, ...lines(members, newlineOf(file))])]
}

/** A heading with its members after a table, with an empty line between them. */
function blockBehind(file: TomlFile, last: Table | undefined, block: string[]): Splice {
  const newline = newlineOf(file)
  if (last !== undefined) {
    const at = endOfLine(file, spanOf({ table: last }).to)
    return { from: at, to: at, text: ['', '', ...block].join(newline) }
  }
  const { text } = file
  const gap =
    text === ''
      ? ''
      : text.endsWith(`${newline}${newline}`)
        ? ''
        : text.endsWith('\n')
          ? newline
          : newline + newline
  return { from: text.length, to: text.length, text: gap + block.join(newline) + newline }
}

function replaced(file: TomlFile, node: Content, value: Literal): Splice[] {
  const [from, to] = node.range
  const text = literal(value, newlineOf(file))
  if (file.text.slice(from, to) === text) return []
  // A comment after the value stays in its column, if there is room.
  const gap = /^[ ]{2,}(?=#)/.exec(file.text.slice(to))?.[0]
  if (gap === undefined || text.includes('\n')) return [{ from, to, text }]
  const width = Math.max(2, gap.length - (text.length - (to - from)))
  return [{ from, to: to + gap.length, text: text + ' '.repeat(width) }]
}

function intoInlineTable(table: Content, name: string, value: Literal): Splice[] {
  if (table.type !== 'TOMLInlineTable') throw new Error(`${name} has no table to stand in`)
  const pair = `${key(name)} = ${literal(value)}`
  const last = table.body.at(-1)
  if (last === undefined) return [{ from: table.range[0], to: table.range[1], text: `{ ${pair} }` }]
  return [{ from: last.range[1], to: last.range[1], text: `, ${pair}` }]
}

/** Adds a line after the line on which something ends. */
function behind(file: TomlFile, { range }: { range: readonly [number, number] }, line: string): Splice {
  const at = endOfLine(file, range[1])
  return { from: at, to: at, text: newlineOf(file) + line }
}

/** If the table is written with dotted keys (`gravity.passengers = 1`), the new member is too. */
function intoDotted(file: TomlFile, parent: Path, name: string, value: Literal): Splice | undefined {
  const holders = [{ begin: [] as Path, body: file.rootPairs }].concat(
    file.tables.map(({ resolvedKey, body }) => ({ begin: resolvedKey, body })),
  )
  for (const { begin, body } of holders) {
    if (parent.length === 0 || !beginsWith(parent, begin)) continue
    const dots = parent.slice(begin.length)
    const sibling = body.findLast((pair) => beginsWith(keysOf(pair), dots))
    if (sibling === undefined) continue
    const dotted = [...dots.map(String), name].map(key).join('.')
    return behind(file, sibling, `${dotted} = ${literal(value)}`)
  }
  return undefined
}

/** A member of the file itself, or of a table that does not exist yet. */
function intoRoot(file: TomlFile, parent: Path, line: string): Splice {
  if (parent.length > 0)
    return blockBehind(file, undefined, [`[${parent.map(String).map(key).join('.')}]`, line])
  const last = file.rootPairs.at(-1)
  if (last !== undefined) return behind(file, last, line)
  return { from: 0, to: 0, text: `${line}${newlineOf(file)}` }
}

function withoutPair(file: TomlFile, pair: Pair): Splice[] {
  if (pair.parent.type !== 'TOMLInlineTable') {
    return [{ from: beginWithRemarks(file, pair.range[0]), to: nextLine(file, pair.range[1]), text: '' }]
  }
  const siblings = pair.parent.body
  return [withoutOneOf(siblings, siblings.indexOf(pair))]
}

/**
 * Comments directly above a table belong to it. Above the first table of a list they may be about
 * the whole list and stay.
 */
function withoutTable(file: TomlFile, table: Table): Splice {
  const begin = table.range[0]
  const isFirst = table.kind === 'array' && table.resolvedKey.at(-1) === 0
  const from = isFirst ? beginOfLine(file, begin) : beginWithRemarks(file, begin)
  let to = nextLine(file, table.range[1])
  while (isBlank(lineAt(file, to)) && to < file.text.length) to = nextLine(file, to)
  return { from, to, text: '' }
}

function withElement(file: TomlFile, list: List, entry: Literal): Splice {
  const text = literal(entry, newlineOf(file))
  const last = list.elements.at(-1)
  if (last === undefined) return { from: list.range[0], to: list.range[1], text: `[${text}]` }
  const at = last.range[1]
  const begin = beginOfLine(file, last.range[0])
  const indent = /^[ \t]*/.exec(file.text.slice(begin))?.[0] ?? ''
  const hasLineOfItsOwn = begin + indent.length === last.range[0] && typeof entry === 'object'
  return { from: at, to: at, text: hasLineOfItsOwn ? `,${newlineOf(file)}${indent}${text}` : `, ${text}` }
}

type List = Extract<Content, { type: 'TOMLArray' }>

function withoutElement(list: Content, index: number): Splice {
  if (list.type !== 'TOMLArray') throw new Error('only lists have entries')
  const only = list.elements.length === 1
  return only ? { from: list.range[0], to: list.range[1], text: '[]' } : withoutOneOf(list.elements, index)
}

/** Removes one of several parts with its comma and its trailing comment. */
function withoutOneOf(parts: readonly { range: readonly [number, number] }[], index: number): Splice {
  const [before, part, next] = [parts[index - 1], parts[index], parts[index + 1]]
  if (part === undefined) throw new Error('there is no such entry')
  if (next !== undefined) return { from: part.range[0], to: next.range[0], text: '' }
  return { from: before?.range[1] ?? part.range[0], to: part.range[1], text: '' }
}

function headingOf(table: Table): { range: readonly [number, number] } {
  return table.key
}

function newlineOf(file: TomlFile): string {
  return file.text.includes('\r\n') ? '\r\n' : '\n'
}

function beginOfLine(file: TomlFile, offset: number): number {
  return file.text.lastIndexOf('\n', offset - 1) + 1
}

/** Where the comments directly above a line begin. */
function beginWithRemarks(file: TomlFile, offset: number): number {
  let begin = beginOfLine(file, offset)
  while (begin > 0) {
    const above = beginOfLine(file, begin - 1)
    if (!/^[ \t]*#/.test(file.text.slice(above, begin))) break
    begin = above
  }
  return begin
}

/** The offset after the last character of a line, excluding the line ending. */
function endOfLine(file: TomlFile, offset: number): number {
  const end = file.text.indexOf('\n', offset)
  if (end < 0) return file.text.length
  return file.text[end - 1] === '\r' && end > offset ? end - 1 : end
}

function nextLine(file: TomlFile, offset: number): number {
  const end = file.text.indexOf('\n', offset)
  return end < 0 ? file.text.length : end + 1
}

function lineAt(file: TomlFile, offset: number): string {
  return file.text.slice(offset, nextLine(file, offset))
}

function isBlank(line: string): boolean {
  return line.trim() === ''
}
