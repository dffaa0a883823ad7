import { describe, expect, it } from 'vitest'
import type { Bar } from '../model/bars'
import { prices } from '../model/fixtures/tiny'
import { NONE } from '../model/motion'
import { Labels, runsOf, type Label } from './labels'
import { rowsOfFleet, rowsOfStands, type GanttRow } from './rows'

const record = prices()
/** The width of every letter, pixels. */
const LETTER_PX = 6

/** The labels of a row at a scale in pixels per second. */
function labelsOf(row: GanttRow, pixelsPerSecond: number): (Label | undefined)[] {
  const place = (bar: Bar): [number, number] => [
    Math.max(0, (bar.begins - record.start) * pixelsPerSecond),
    (Math.min(bar.ends, record.end + 3600) - record.start) * pixelsPerSecond,
  ]
  const labels = new Labels(record, (text) => text.length * LETTER_PX, place)
  return runsOf(row.bars, 0, row.bars.length).map((run) => labels.of(run, row))
}

function fleetRow(aircraft: number): GanttRow {
  const row = rowsOfFleet(record)[aircraft]
  if (row === undefined) throw new Error('the fleet has a row for each aircraft')
  return row
}

describe('labels of the fleet', () => {
  it('contain origin and destination of flights, and omit holds', () => {
    const texts = labelsOf(fleetRow(0), 1).map((label) => label?.text)
    const legs = record.legs.filter((leg) => leg.aircraft === 0)
    const id = (vertiport: number) => record.vertiports[vertiport]?.id
    const names = legs.map(({ from, to }) => (from === to ? undefined : `${id(from)} → ${id(to)}`))
    expect(texts).toEqual(names)
  })

  it('omit the origin if there is less room', () => {
    // The first flight takes 661 s, which is 53 pixels here: room for eight letters.
    const [first] = labelsOf(fleetRow(0), 0.08)
    expect(first).toMatchObject({ text: '→ East', isLonger: false })
  })

  it('stay on their bars if there is room', () => {
    for (const label of labelsOf(fleetRow(0), 1)) if (label !== undefined) expect(label.isLonger).toBe(false)
  })

  it('continue over the charging after a short flight, and no further', () => {
    // The first flight takes 661 s and its charging 509 s: 16 and 12 pixels for four letters, which
    // take 24.
    const [first] = labelsOf(fleetRow(0), 0.0245)
    expect(first).toMatchObject({ text: 'East', isLonger: true })
    expect((first?.right ?? 0) - (first?.left ?? 0)).toBeGreaterThanOrEqual(4 * LETTER_PX)
    const [flight, charge] = fleetRow(0).bars
    expect(charge?.leg).toBe(flight?.leg)
    expect(first?.right).toBeLessThanOrEqual(((charge?.ends ?? 0) - record.start) * 0.0245)
  })

  it('are cut off if even that is too narrow, and absent if too few letters remain', () => {
    // No name of this day is long enough to be cut to three letters.
    expect(labelsOf(fleetRow(0), 0.017)[0]).toBeUndefined()
    expect(labelsOf(fleetRow(0), 0.005)[0]).toBeUndefined()
  })
})

describe('labels of stands', () => {
  it('name each stay once', () => {
    for (const row of rowsOfStands(record)) {
      const labels = labelsOf(row, 1)
      expect(labels).toHaveLength(new Set(row.bars.map(({ leg, aircraft }) => `${leg} ${aircraft}`)).size)
      expect(labels.every((label) => label !== undefined)).toBe(true)
    }
  })

  it('are never cut to a prefix of another aircraft', () => {
    const texts = rowsOfStands(record).flatMap((row) => labelsOf(row, 0.01).map((label) => label?.text))
    expect(texts.filter((text) => text?.includes('…'))).toEqual([])
  })
})

it('bars of an aircraft before its first flight are a separate run', () => {
  const bar = { kind: 'standing', begins: 0, ends: 10, load: 0, isExpected: false } as const
  const runs = runsOf(
    [
      { ...bar, aircraft: 0, leg: NONE },
      { ...bar, aircraft: 1, leg: NONE },
      { ...bar, aircraft: 1, leg: 4 },
    ],
    0,
    3,
  )
  expect(runs.map((run) => run.length)).toEqual([1, 1, 1])
})
