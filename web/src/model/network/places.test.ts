import { readFileSync } from 'node:fs'
import { describe, expect, it } from 'vitest'
import { total } from '../arrays'
import { setPair, setPeriod, withDailyDemand } from './change'
import { byPair, byPeriod, meanDemand } from './demand'
import { draftOf, member } from './draft'
import { apply, type Splice } from './edits'
import {
  addVertiport,
  freeId,
  moveVertiport,
  placeOf,
  removeVertiport,
  renameType,
  renameVertiport,
} from './places'
import { TomlFile } from './toml'

const read = (name: string) =>
  new TomlFile(readFileSync(new URL(`../../../../networks/${name}.toml`, import.meta.url), 'utf8'))
const after = (file: TomlFile, splices: Splice[]) => new TomlFile(apply(file.text, splices))

const hourly = new TomlFile(`name = "h"
[[vertiports]]
id = "A"
x_mi = 0
y_mi = 0
[[vertiports]]
id = "B"
x_mi = 3
y_mi = 4
[hourly_demand]
periods = ["06:00:00", "07:00:00"]
[[hourly_demand.pairs]]
from = "A"
to = "B"
passengers = [1, 3]
[[closures]]
start = "06:00:00"
end = "07:00:00"
vertiports = ["A", "B"]
`)

describe('vertiports', () => {
  it('move, in degrees and in miles', () => {
    const globe = after(
      read('new-york'),
      moveVertiport(read('new-york'), 2, { east: -73.9712345, north: 40.7 }),
    )
    expect(placeOf(draftOf(globe.value), 2)).toEqual({ east: -73.97123, north: 40.7 })
    const plane = after(read('paper'), moveVertiport(read('paper'), 0, { east: 1.234, north: 9 }))
    expect(placeOf(draftOf(plane.value), 0)).toEqual({ east: 1.23, north: 9 })
    expect(draftOf(plane.value).isGlobe).toBe(false)
  })

  it('are added with their weight, or with their row of demand', () => {
    const file = after(read('new-york'), addVertiport(read('new-york'), { east: -73.9, north: 40.8 }))
    const draft = draftOf(file.value)
    expect(draft.vertiports.at(-1)).toMatchObject({ id: 'V1', latitude: 40.8, longitude: -73.9, stands: 4 })
    expect(member(file.value, ['daily_demand', 'gravity', 'weights', 9])).toBe(1)
    const table = new TomlFile(withDailyDemand(file))
    const more = after(table, addVertiport(table, { east: -73.8, north: 40.9 }))
    const passengers = member(more.value, ['daily_demand', 'passengers']) as number[][]
    expect([passengers.length, ...new Set(passengers.map((row) => row.length))]).toEqual([11, 11])
    expect(after(read('paper'), addVertiport(read('paper'), { east: 1, north: 2 })).text).toContain(
      '[[vertiports]]\nid = "V9"\nx_mi = 1\ny_mi = 2\nstands = 4\nbusy = false\n',
    )
  })

  it('are removed with all references to them', () => {
    const file = after(read('new-york'), removeVertiport(read('new-york'), 6))
    expect(file.text).not.toContain('"TEB"')
    expect(member(file.value, ['daily_demand', 'gravity', 'weights'])).toEqual([3, 3, 2, 4, 3, 3, 1, 1])
    expect(member(file.value, ['disturbances', 'closures', 0, 'routes'])).toHaveLength(2)
    const paper = after(read('disrupted'), removeVertiport(read('disrupted'), 1))
    expect(paper.text).not.toContain('"V2"')
    const pairs = after(hourly, removeVertiport(hourly, 1))
    expect(pairs.value).toMatchObject({ closures: [{ vertiports: ['A'] }] })
    expect(pairs.text).not.toContain('hourly_demand.pairs')
  })

  it('keep all references under another id', () => {
    const file = after(read('new-york'), renameVertiport(read('new-york'), 6, 'KTEB'))
    expect(file.text).not.toContain('"TEB"')
    expect(file.text.match(/"KTEB"/g)).toHaveLength(3)
    const both = after(hourly, renameVertiport(hourly, 0, 'North'))
    expect(both.value).toMatchObject({
      closures: [{ vertiports: ['North', 'B'] }],
      hourly_demand: { pairs: [{ from: 'North' }] },
    })
    const types = after(read('new-york'), renameType(read('new-york'), 0, 'archer'))
    expect(draftOf(types.value).fleet[0]?.type).toBe('archer')
  })

  it('get unused ids', () => {
    expect(freeId([])).toBe('V1')
    expect(freeId(['V1', 'V9'])).toBe('V10')
    expect(freeId(['JFK'])).toBe('V1')
    expect(freeId(['A2', 'A3', 'A1'])).toBe('A4')
  })
})

describe('demand', () => {
  it('equals that of the service in all models', () => {
    // The totals that the service reports for the shipped networks.
    expect(total(byPeriod(draftOf(read('new-york').value)))).toBeCloseTo(7752, 6)
    expect(total(byPeriod(draftOf(read('paper').value)))).toBe(26100)
    const mean = meanDemand(draftOf(read('paper').value))
    // V1 is busy and V5 is not: the morning peak is at 8:00, the evening peak at 16:00.
    expect([mean(2, 4, 0), mean(2, 0, 4), mean(10, 0, 4), mean(5, 0, 1), mean(5, 0, 4)]).toEqual([
      100, 30, 100, 50, 30,
    ])
    expect(byPair(draftOf(hourly.value))).toEqual([
      [0, 4],
      [0, 0],
    ])
  })

  it('is unchanged when converted to a table of pairs', () => {
    for (const name of ['new-york', 'paper', 'as-coded', 'paris']) {
      const file = read(name)
      const table = new TomlFile(withDailyDemand(file))
      const [before, now] = [draftOf(file.value), draftOf(table.value)]
      expect(now.demand?.model).toBe('daily')
      expect(now.periods).toEqual(before.periods)
      byPeriod(now).forEach((one, period) =>
        expect(Math.abs(one - (byPeriod(before)[period] ?? 0))).toBeLessThan(Math.max(1, one * 1e-3)),
      )
    }
  })

  it('changes for one pair', () => {
    const table = new TomlFile(withDailyDemand(read('new-york')))
    const one = after(table, setPair(table, 0, 3, 123.456))
    expect(member(one.value, ['daily_demand', 'passengers', 0, 3])).toBe(123.46)
    const scaled = after(hourly, setPair(hourly, 0, 1, 8))
    expect(member(scaled.value, ['hourly_demand', 'pairs', 0, 'passengers'])).toEqual([2, 6])
    const added = after(hourly, setPair(hourly, 1, 0, 8))
    expect(member(added.value, ['hourly_demand', 'pairs', 1])).toEqual({
      from: 'B',
      to: 'A',
      passengers: [2, 6],
    })
    expect(setPair(read('paper'), 0, 1, 3)).toEqual([])
  })

  it('changes for one period', () => {
    const file = read('new-york')
    const quiet = byPeriod(draftOf(file.value))[0] ?? 0
    const twice = after(file, setPeriod(file, 0, 2 * quiet))
    expect(member(twice.value, ['daily_demand', 'shares_percent', 0])).toBe(6.4)
    const none = after(file, setPeriod(file, 0, 0))
    const again = after(none, setPeriod(none, 0, quiet))
    expect(member(again.value, ['daily_demand', 'shares_percent', 0])).toBeCloseTo(3.2, 2)
    const scaled = after(hourly, setPeriod(hourly, 1, 6))
    expect(member(scaled.value, ['hourly_demand', 'pairs', 0, 'passengers'])).toEqual([1, 6])
  })
})
