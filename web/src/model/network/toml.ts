// A network file as text with the position of every member. A form can change one number and keep
// everything else as written: comments, order, spaces. The parser is toml-eslint-parser, because it
// keeps the position of every node. Libraries that rewrite a file, or patch it from an object, lose
// comments between two tables.

import { getStaticTOMLValue, ParseError, parseTOML, type AST } from 'toml-eslint-parser'

export type Step = string | number
/** The path to a member: `['vertiports', 2, 'stands']`. */
export type Path = readonly Step[]

/** A part of the text, from its first character to the one after its last. */
export interface Span {
  from: number
  to: number
}

/** Why a text is not valid TOML. Lines count from 1, columns from 0. */
export class TomlError extends Error {
  override readonly name = 'TomlError'
  constructor(
    message: string,
    readonly line: number,
    readonly column: number,
    readonly offset: number,
  ) {
    super(message)
  }
}

export type Content = AST.TOMLContentNode
export type Pair = AST.TOMLKeyValue
export type Table = AST.TOMLTable

/** The target of a path: a table with a heading, or a value, which may have its own key. */
export type Found = { table: Table } | { value: Content; pair: Pair | undefined }

export class TomlFile {
  readonly #top: AST.TOMLTopLevelTable
  #value: unknown

  /** Throws a `TomlError` if the text is not valid TOML. */
  constructor(readonly text: string) {
    this.#top = parsed(text)
  }

  /** Everything in the file as plain values. */
  get value(): unknown {
    return (this.#value ??= getStaticTOMLValue(this.#top))
  }

  /** Members before the first heading. */
  get rootPairs(): Pair[] {
    return this.#top.body.filter((one): one is Pair => one.type === 'TOMLKeyValue')
  }

  get tables(): Table[] {
    return this.#top.body.filter((one): one is Table => one.type === 'TOMLTable')
  }

  /** The target of a path; undefined if it does not exist. */
  find(path: Path): Found | undefined {
    for (const pair of this.rootPairs) {
      const found = withinPair(pair, path)
      if (found !== undefined) return found
    }
    for (const table of this.tables) {
      if (!beginsWith(path, table.resolvedKey)) continue
      const rest = path.slice(table.resolvedKey.length)
      if (rest.length === 0) return { table }
      for (const pair of table.body) {
        const found = withinPair(pair, rest)
        if (found !== undefined) return found
      }
    }
    return undefined
  }

  /**
   * The position of a member, or of the nearest existing one around it; undefined if there is none.
   */
  span(path: Path): Span | undefined {
    for (let length = path.length; length > 0; length--) {
      const begin = path.slice(0, length)
      const found = this.find(begin)
      if (found !== undefined) return spanOf(found)
      const table = this.tables.find(({ resolvedKey }) => beginsWith(resolvedKey, begin))
      if (table !== undefined) return spanOf({ table })
    }
    return undefined
  }

  /** The member that contains an offset in the text; empty if there is none. */
  pathAt(offset: number): Path {
    for (const pair of this.rootPairs) if (isWithin(pair, offset)) return pathWithin(pair, offset)
    // A table ends where the next begins, so the lines after its last member belong to it.
    const table = this.tables.findLast(({ range }) => range[0] <= offset)
    if (table === undefined) return []
    const pair = table.body.find((one) => isWithin(one, offset))
    return [...table.resolvedKey, ...(pair === undefined ? [] : pathWithin(pair, offset))]
  }

  /** The line of an offset, from 1. */
  line(offset: number): number {
    return this.text.slice(0, offset).split('\n').length
  }
}

function parsed(text: string): AST.TOMLTopLevelTable {
  try {
    return parseTOML(text).body[0]
  } catch (cause) {
    if (!(cause instanceof ParseError)) throw cause
    throw new TomlError(cause.message, cause.lineNumber, cause.column, cause.index)
  }
}

export function keysOf(pair: Pair): string[] {
  return pair.key.keys.map((key) => (key.type === 'TOMLBare' ? key.name : key.value))
}

export function beginsWith(path: Path, begin: Path): boolean {
  return begin.length <= path.length && begin.every((step, index) => step === path[index])
}

export function spanOf(found: Found): Span {
  const [from, to] = 'table' in found ? found.table.range : (found.pair ?? found.value).range
  return { from, to }
}

function withinPair(pair: Pair, path: Path): Found | undefined {
  const keys = keysOf(pair)
  if (!beginsWith(path, keys)) return undefined
  return within(pair.value, path.slice(keys.length), pair)
}

function within(value: Content, path: Path, pair: Pair | undefined): Found | undefined {
  const [step, ...rest] = path
  if (step === undefined) return { value, pair }
  if (value.type === 'TOMLArray' && typeof step === 'number') {
    const element = value.elements[step]
    return element === undefined ? undefined : within(element, rest, undefined)
  }
  if (value.type !== 'TOMLInlineTable') return undefined
  for (const member of value.body) {
    const found = withinPair(member, path)
    if (found !== undefined) return found
  }
  return undefined
}

function isWithin({ range: [from, to] }: { range: readonly [number, number] }, offset: number): boolean {
  return from <= offset && offset <= to
}

function pathWithin(pair: Pair, offset: number): Path {
  return [...keysOf(pair), ...pathWithinValue(pair.value, offset)]
}

function pathWithinValue(value: Content, offset: number): Path {
  if (value.type === 'TOMLArray') {
    const index = value.elements.findIndex((one) => isWithin(one, offset))
    const element = value.elements[index]
    return element === undefined ? [] : [index, ...pathWithinValue(element, offset)]
  }
  if (value.type !== 'TOMLInlineTable') return []
  const member = value.body.find((one) => isWithin(one, offset))
  return member === undefined ? [] : pathWithin(member, offset)
}
