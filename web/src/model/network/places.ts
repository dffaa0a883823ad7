// Changes to the vertiports of a network and to everything that refers to them. A vertiport has
// rows in demand tables, a weight, delays, corridors and closures. A network that omits some of
// them is invalid.

import { draftOf, member, type Draft } from './draft'
import { append, remove, set, type Splice } from './edits'
import type { Literal } from './literals'
import { rounded } from './demand'
import type { Path, TomlFile } from './toml'

/** A place: degrees east and north, or miles. */
export interface Place {
  east: number
  north: number
}

/** Five digits are about a metre; two digits of a mile are about 16 metres. */
const DEGREE_DIGITS = 5
const MILE_DIGITS = 2

const NEW_STANDS = 4

/** The members that contain a vertiport's position. */
export function placeMembers(isGlobe: boolean): { east: string; north: string } {
  return isGlobe ? { east: 'longitude', north: 'latitude' } : { east: 'x_mi', north: 'y_mi' }
}

export function placeOf(draft: Draft, vertiport: number): Place | undefined {
  const one = draft.vertiports[vertiport]
  const [east, north] = draft.isGlobe ? [one?.longitude, one?.latitude] : [one?.x_mi, one?.y_mi]
  return east === undefined || north === undefined ? undefined : { east, north }
}

function roundedPlace({ east, north }: Place, isGlobe: boolean): Place {
  const digits = isGlobe ? DEGREE_DIGITS : MILE_DIGITS
  return { east: rounded(east, digits), north: rounded(north, digits) }
}

export function moveVertiport(file: TomlFile, vertiport: number, place: Place): Splice[] {
  const { isGlobe } = draftOf(file.value)
  const names = placeMembers(isGlobe)
  const { east, north } = roundedPlace(place, isGlobe)
  return [
    ...set(file, ['vertiports', vertiport, names.east], east),
    ...set(file, ['vertiports', vertiport, names.north], north),
  ]
}

/** Adds a vertiport without demand, unless its demand follows from a weight. */
export function addVertiport(file: TomlFile, place: Place): Splice[] {
  const draft = draftOf(file.value)
  const names = placeMembers(draft.isGlobe)
  const { east, north } = roundedPlace(place, draft.isGlobe)
  const [first, second] = draft.isGlobe
    ? [[names.north, north] as const, [names.east, east] as const]
    : [[names.east, east] as const, [names.north, north] as const]
  const id = freeId(draft.vertiports.map((one) => one.id))
  const table = { id, [first[0]]: first[1], [second[0]]: second[1], stands: NEW_STANDS, busy: false }
  const { demand } = draft
  if (demand?.model === 'gravity')
    return [...append(file, ['vertiports'], table), ...append(file, [...DAILY, 'gravity', 'weights'], 1)]
  if (demand?.model !== 'daily') return append(file, ['vertiports'], table)
  const passengers: Path = [...DAILY, 'passengers']
  return [
    ...append(file, ['vertiports'], table),
    ...demand.passengers.flatMap((_, row) => append(file, [...passengers, row], 0)),
    ...append(file, passengers, new Array<number>(draft.vertiports.length + 1).fill(0)),
  ]
}

const DAILY: Path = ['daily_demand']

/** Removes a vertiport and every row, weight, delay and route of it. */
export function removeVertiport(file: TomlFile, vertiport: number): Splice[] {
  const draft = draftOf(file.value)
  const id = draft.vertiports[vertiport]?.id ?? ''
  return [
    ...remove(file, ['vertiports', vertiport]),
    ...withoutDemand(file, draft, vertiport),
    ...references(file).flatMap((list) => withoutReferences(file, list, id)),
  ]
}

function withoutDemand(file: TomlFile, { demand }: Draft, vertiport: number): Splice[] {
  if (demand?.model === 'gravity' && vertiport < demand.weights.length)
    return remove(file, [...DAILY, 'gravity', 'weights', vertiport])
  if (demand?.model !== 'daily' || vertiport >= demand.passengers.length) return []
  const rest = demand.passengers
    .filter((_, row) => row !== vertiport)
    .map((row) => row.filter((_, column) => column !== vertiport))
  return set(file, [...DAILY, 'passengers'], rest)
}

/** Changes the id of a vertiport everywhere. */
export function renameVertiport(file: TomlFile, vertiport: number, id: string): Splice[] {
  const former = draftOf(file.value).vertiports[vertiport]?.id
  const own = set(file, ['vertiports', vertiport, 'id'], id)
  if (former === undefined || former === '') return own
  return [...own, ...references(file).flatMap((list) => renamed(file, list, former, id))]
}

/** Changes the id of an aircraft type, in the fleet too. */
export function renameType(file: TomlFile, type: number, id: string): Splice[] {
  const draft = draftOf(file.value)
  const former = draft.types[type]?.id
  const own = set(file, ['aircraft_types', type, 'id'], id)
  if (former === undefined || former === '') return own
  const uses = draft.fleet.flatMap((one, at) =>
    one.type === former ? set(file, ['fleet', at, 'type'], id) : [],
  )
  return [...own, ...uses]
}

/** An unused id: the word of the last one with the next number. */
export function freeId(ids: readonly string[]): string {
  const [, word = 'V', number = '0'] = /^(.*?)(\d+)$/.exec(ids.at(-1) ?? '') ?? []
  let next = Number(number) + 1
  while (ids.includes(`${word}${next}`)) next++
  return `${word}${next}`
}

/** A list whose entries are names of vertiports, or contain them in some members. */
interface ReferenceList {
  path: Path
  entries: readonly unknown[]
  names: readonly string[]
}

function references(file: TomlFile): ReferenceList[] {
  const route = ['from', 'to']
  const lists = (path: Path, names: readonly string[]): ReferenceList[] => {
    const entries = member(file.value, path)
    return Array.isArray(entries) ? [{ path, entries: entries as unknown[], names }] : []
  }
  const within = (path: Path) => {
    const entries = member(file.value, path)
    return (Array.isArray(entries) ? entries : []).flatMap((_, at) => [
      ...lists([...path, at, 'routes'], route),
      ...lists([...path, at, 'vertiports'], []),
    ])
  }
  return [
    ...lists(['corridors'], route),
    ...lists(['hourly_demand', 'pairs'], route),
    ...lists(['disturbances', 'takeoff_delays', 'vertiports'], ['at']),
    ...within(['closures']),
    ...within(['disturbances', 'closures']),
  ]
}

function isAbout(entry: unknown, names: readonly string[], id: string): boolean {
  return entry === id || names.some((name) => member(entry, [name]) === id)
}

function withoutReferences(file: TomlFile, { path, entries, names }: ReferenceList, id: string): Splice[] {
  const gone = entries.flatMap((entry, at) => (isAbout(entry, names, id) ? [at] : []))
  if (gone.length === 0) return []
  // Entries with headings are removed one by one; a list in brackets is rewritten without them.
  const isInBrackets = file.find(path) !== undefined
  if (gone.length === 1 || !isInBrackets) return gone.flatMap((at) => remove(file, [...path, at]))
  return set(file, path, entries.filter((_, at) => !gone.includes(at)) as Literal[])
}

function renamed(
  file: TomlFile,
  { path, entries, names }: ReferenceList,
  former: string,
  id: string,
): Splice[] {
  return entries.flatMap((entry, at) => {
    if (entry === former) return set(file, [...path, at], id)
    const members = names.filter((name) => member(entry, [name]) === former)
    return members.flatMap((name) => set(file, [...path, at, name], id))
  })
}
