import { readFileSync } from 'node:fs'
import { expect, it } from 'vitest'
import { findingAt, findingOf, findingOfWarning } from './findings'
import { TomlFile } from './toml'

const text = readFileSync(new URL('../../../../networks/new-york.toml', import.meta.url), 'utf8')
const file = new TomlFile(text)
const find = (detail: string, code = 'V104') =>
  findingOf({ code, detail: `the network: ${detail}`, hint: undefined }, file)

it.each([
  ['vertiport "JFK": stands must be at least 1, found 0', ['vertiports', 3, 'stands'], 'stands = 8'],
  [
    'vertiport "EWR" must have exactly one of x_mi with y_mi and latitude with longitude, and nothing of the other, found 0',
    ['vertiports', 5],
    '[[vertiports]]  # Newark Liberty International',
  ],
  [
    'vertiports[6]: vertiport "JRB" has the same id as an entry before it',
    ['vertiports', 6],
    '[[vertiports]]  # Teterboro',
  ],
  [
    'aircraft type "midnight": seats must be a whole number, found 4.5',
    ['aircraft_types', 0, 'seats'],
    'seats = 4',
  ],
  [
    'fleet[0]: type names "nope", which is not among the aircraft types',
    ['fleet', 0, 'type'],
    'type = "midnight"',
  ],
  ['the fleet has 216 aircraft, and the vertiports have 48 stands together', ['fleet'], '[[fleet]]'],
  [
    'daily_demand: gravity: weights must have an entry for each of 9 vertiports, found 8',
    ['daily_demand', 'gravity', 'weights'],
    'weights = [',
  ],
  [
    'daily_demand: gravity: weights[2] must be at least 0, found -2',
    ['daily_demand', 'gravity', 'weights', 2],
    'weights = [',
  ],
  ['operations: start must not be after end 22:00:00, found 23:00:00', ['operations', 'start'], 'start = '],
  [
    'disturbances: closures[0]: routes[2]: to names "LGB", which is not among the vertiports',
    ['disturbances', 'closures', 0, 'routes', 2, 'to'],
    '    { from = "6N5"',
  ],
  [
    'periods[2] must be after the period before it, 08:00:00, found 08:00:00',
    ['daily_demand', 'periods', 2],
    '    "06:00:00"',
  ],
  ['name must be 1 to 40 letters a-z, found "new york"', ['name'], 'name = '],
])('finds the member of: %s', (detail, path, line) => {
  const found = find(detail)
  expect(found.path).toEqual(path)
  const lines = text.split('\n')
  expect(lines[(found.line ?? 0) - 1]?.startsWith(line)).toBe(true)
})

it('finds an end of the range of charges at the start', () => {
  const drawn = new TomlFile('name = "a"\nstart_charge = [0.9, 0.6]\n')
  const detail = 'the network: start_charge[1] must be at least start_charge[0], 0.9, found 0.6'
  const found = findingOf({ code: 'V104', detail, hint: undefined }, drawn)
  expect(found).toMatchObject({ path: ['start_charge', 1], line: 2 })
})

it('names entries by kind and number, and empty members as empty', () => {
  const found = find('vertiports[0]: id must be 1 to 64 characters without control characters, found ""')
  expect(found.message).toBe('vertiport no. 1 of the file: id must not be empty')
  expect(found.path).toEqual(['vertiports', 0, 'id'])
  expect(find('fleet[0]: type names "nope", which is not among the aircraft types').message).toBe(
    'entry no. 1 of the fleet: type names "nope", which is not among the aircraft types',
  )
})

it('takes the line from the TOML parser', () => {
  const unknown = find(
    'line 46, column 1: vertiports[3].stnds: unknown field `stnds`, expected one of `id`',
    'V106',
  )
  expect(unknown).toMatchObject({ path: ['vertiports', 3, 'stnds'], line: 46, code: 'V106' })
  expect(unknown.message).toBe('vertiports[3].stnds: unknown field `stnds`, expected one of `id`')
  expect(find('line 9, column 12: unclosed table, expected `]`', 'V105')).toMatchObject({ path: [], line: 9 })
})

it('handles other messages of the service', () => {
  const zone = {
    code: 'V601',
    detail: 'the request is not understood: "America/Nowhere" is no time zone',
    hint: undefined,
  }
  expect(findingOf(zone, file).path).toEqual(['time_zone'])
  expect(find('has no member `format`', 'V107')).toMatchObject({ path: [], line: undefined })
  const warning = findingOfWarning('no aircraft can fly to or from vertiport "TEB": the nearest is far', file)
  expect(warning).toMatchObject({ kind: 'warning', path: ['vertiports', 6] })
})

it('is shown at its field and at the entry around it', () => {
  const finding = find('vertiport "JFK": stands must be at least 1, found 0')
  expect(findingAt([finding], ['vertiports', 3, 'stands'])).toBe(finding)
  expect(findingAt([finding], ['vertiports', 3])).toBe(finding)
  expect(findingAt([finding], ['vertiports', 3, 'id'])).toBeUndefined()
})
