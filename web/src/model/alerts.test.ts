import { describe, expect, it } from 'vitest'
import type { DayState, TakenEvent } from '../api/types'
import { alertsOf, headlineOf, listed, type Alert } from './alerts'
import type { DayRecord, LegRecord } from './record'
import type { Scenario } from './scenario'

const SEVEN = 7 * 3600

function leg(more: Partial<LegRecord>): LegRecord {
  return {
    aircraft: 0,
    from: 0,
    to: 1,
    decided: SEVEN - 3600,
    departs: SEVEN - 3600,
    arrives: SEVEN,
    ready: SEVEN + 1800,
    passengers: 4,
    profit_usd: 90,
    is_expected: false,
    ...more,
  }
}

interface Given {
  chargesAsNeeded?: boolean
  legs?: LegRecord[]
  closures?: DayRecord['closures']
  outages?: DayRecord['outages']
  taken?: number[]
  notices?: DayState['notices']
  events?: TakenEvent[]
}

function alerts(given: Given, time = SEVEN): Alert[] {
  const ids = ['V1', 'V2', 'V3']
  const aircraft = { id: 'A01', type: 'midnight', seats: 4, battery_kwh: 140 }
  const record = {
    start: SEVEN,
    aircraft: [aircraft, { ...aircraft, id: 'A02' }],
    vertiports: ids.map((id) => ({ id, stands: 6 })),
    legs: given.legs ?? [],
    closures: given.closures ?? [],
    outages: given.outages ?? [],
    chargesAsNeeded: given.chargesAsNeeded,
  } as unknown as DayRecord
  const state = {
    aircraft: [],
    vertiports: ids.map((id, at) => ({ id, stands: 6, taken: given.taken?.[at] ?? 0, closed: [] })),
    notices: given.notices ?? [],
  } as unknown as DayState
  const aircraft_types = [{ id: 'midnight', reserve_kwh: 20 }]
  const scenario = { aircraft_types } as unknown as Scenario
  return alertsOf({ scenario, state, record, events: given.events ?? [], time })
}

describe('alerts', () => {
  it('are absent on an undisturbed day', () => {
    const flight = leg({ awaited: { report: 'landing', due: SEVEN + 600 } })
    expect(alerts({ legs: [flight], taken: [5, 2, 0] })).toEqual([])
  })

  it('name a report that is overdue, and are critical after a quarter of an hour', () => {
    const late = (minutes: number) =>
      leg({ awaited: { report: 'landing', due: SEVEN }, arrives: SEVEN + 60 * minutes })
    expect(alerts({ legs: [late(4)] })).toEqual([])
    expect(alerts({ legs: [late(6)] })[0]).toMatchObject({ severity: 'warning', since: SEVEN })
    expect(alerts({ legs: [late(15)] })[0]).toMatchObject({
      severity: 'critical',
      matter: { kind: 'overdue', aircraft: 'A01', to: 'V2', report: 'landing' },
      target: { kind: 'aircraft', aircraft: 0 },
    })
  })

  it('distinguish a full vertiport from one with more aircraft than stands', () => {
    const found = alerts({ taken: [6, 7, 5] })
    expect(found.map(({ key, severity }) => [key, severity])).toEqual([
      [`over_full V2 ${SEVEN}`, 'critical'],
      [`full V1 ${SEVEN}`, 'notice'],
    ])
  })

  it('name a closure once, and how many are on the way there', () => {
    const closures = [{ vertiport: 1, since: SEVEN - 600, until: SEVEN + 600 }]
    const [alert, ...others] = alerts({ closures })
    expect(others).toEqual([])
    expect(alert).toMatchObject({ severity: 'warning', matter: { what: 'V2', underWay: [] } })
    const flight = leg({ awaited: { report: 'landing', due: SEVEN + 60 } })
    const [struck] = alerts({ closures, legs: [flight] })
    expect(struck).toMatchObject({ severity: 'critical', matter: { underWay: ['A01'] } })
    expect(alerts({ closures }, SEVEN + 600)).toEqual([])
  })

  it('name a vertiport once when separate reports have closed every route from and to it', () => {
    const route = (from: number, to: number, since: number, until?: number) => ({
      ...{ from, to, since: SEVEN - since },
      ...(until === undefined ? {} : { until: SEVEN + until }),
    })
    const all = [route(1, 0, 900, 600), route(0, 1, 600), route(1, 2, 300, 1200), route(2, 1, 900, 900)]
    const flight = leg({ from: 2, awaited: { report: 'landing', due: SEVEN + 60 } })
    const away = leg({ aircraft: 1, from: 1, to: 0, awaited: { report: 'landing', due: SEVEN + 60 } })
    const found = alerts({ closures: [...all, route(0, 2, 60)], legs: [flight, away] })
    expect(found.map(({ severity, matter, since }) => ({ severity, matter, since }))).toEqual([
      {
        severity: 'critical',
        matter: { kind: 'closed', what: 'V2', until: SEVEN + 600, underWay: ['A01'] },
        since: SEVEN - 300,
      },
      {
        severity: 'warning',
        matter: { kind: 'closed', what: 'V1 → V3', until: undefined, underWay: [] },
        since: SEVEN - 60,
      },
    ])
    // As long as one route is open, each closed one is an alert.
    expect(alerts({ closures: all.slice(1) })).toHaveLength(3)
    expect(alerts({ closures: all }, SEVEN + 600)).toHaveLength(3)
  })

  it('count the routes of other closed vertiports, and do not repeat those of a closed one', () => {
    const whole = { vertiport: 0, since: SEVEN - 600 }
    const both = [
      { from: 1, to: 2, since: SEVEN },
      { from: 2, to: 1, since: SEVEN },
    ]
    const names = (closures: DayRecord['closures']) =>
      alerts({ closures }).map(({ matter }) => 'what' in matter && matter.what)
    expect(names([whole, { from: 0, to: 1, since: SEVEN - 60 }])).toEqual(['V1'])
    expect(names([whole, { ...whole, vertiport: 1 }])).toEqual(['V1', 'V2'])
    expect(names([whole, ...both])).toEqual(['V1', 'V2', 'V3'])
  })

  it('name outages without an end, and flights that land with little charge', () => {
    const outages = [{ aircraft: 1, since: SEVEN - 60 }]
    expect(alerts({ outages })[0]).toMatchObject({ matter: { aircraft: 'A02', until: undefined } })
    const flight = leg({ awaited: { report: 'landing', due: SEVEN + 600 }, energy_kwh: 133 })
    const low = alerts({ legs: [flight] })
    expect(low.map(({ matter }) => matter)).toEqual([
      { kind: 'low_charge', aircraft: 'A01', to: 'V2', percent: 5 },
    ])
  })

  it('name flights below their reserve on a day that charges as needed', () => {
    const flight = (lands_with_kwh: number) =>
      leg({ awaited: { report: 'landing', due: SEVEN + 600 }, lands_with_kwh })
    const of = (kwh: number) => alerts({ chargesAsNeeded: true, legs: [flight(kwh)] })
    expect(of(20)).toEqual([])
    expect(of(7).map(({ matter }) => matter)).toEqual([
      { kind: 'low_charge', aircraft: 'A01', to: 'V2', percent: 5 },
    ])
  })

  it('include notices of events, and current notices only if no other alert covers them', () => {
    const notices = [
      { seq: 4, code: 'diverted', aircraft: 'A02', text: 'aircraft "A02" landed at "V1" instead of "V3"' },
      { seq: null, code: 'more_than_stands', vertiport: 'V1', text: 'vertiport "V1" has 7 aircraft' },
      { seq: null, code: 'more_than_stands', vertiport: 'V2', text: 'vertiport "V2" has 7 aircraft' },
    ]
    const event = { type: 'landed', aircraft: 'A02', time: '06:58:00' }
    const events = [{ seq: 4, event }] as unknown as TakenEvent[]
    const found = alerts({ notices, events, taken: [0, 7, 0] })
    expect(found.map(({ matter }) => ('text' in matter ? matter.text : matter.kind))).toEqual([
      'over_full',
      notices[0]?.text,
      notices[1]?.text,
    ])
    expect(found[1]).toMatchObject({ since: SEVEN - 120, target: { aircraft: 1 } })
  })
})

it('alerts about the same subject are one', () => {
  const closure = { from: 0, to: 1, since: SEVEN - 60, until: SEVEN + 60 }
  expect(alerts({ closures: [closure, closure] })).toHaveLength(1)
})

describe('a flight without the energy for its way', () => {
  const text = 'aircraft "A01" departs without the energy for its flight'
  const without = { code: 'without_energy', aircraft: 'A01', vertiport: 'V2', text }

  it('is one critical alert, above a closed route and a report that is long overdue', () => {
    const closures = [{ from: 0, to: 1, since: SEVEN - 3600 }]
    const long = leg({ aircraft: 1, awaited: { report: 'landing', due: SEVEN - 1800 }, arrives: SEVEN + 60 })
    const notices = [
      { ...without, seq: 4 },
      { ...without, seq: null },
    ]
    const found = alerts({ closures, legs: [long], notices })
    expect(found[0]).toMatchObject({ severity: 'critical', matter: { kind: 'notice', text } })
    expect(found.filter(({ matter }) => matter.kind === 'notice')).toHaveLength(1)
  })

  it('is the same alert in flight, where its charge is no other, and after its landing', () => {
    const flight = { decided: SEVEN - 900, lands_with_kwh: -3 }
    const low = leg({ ...flight, awaited: { report: 'landing', due: SEVEN + 600 } })
    const notices = [{ ...without, seq: null }]
    const inFlight = alerts({ chargesAsNeeded: true, legs: [low], notices })
    expect(inFlight.map(({ severity }) => severity)).toEqual(['critical'])
    const landed = alerts({ chargesAsNeeded: true, legs: [leg(flight)], notices: [{ ...without, seq: 4 }] })
    expect(landed.map(({ key, severity }) => [key, severity])).toEqual([[inFlight[0]?.key, 'warning']])
  })

  it('has low charge above a closed route that is as severe', () => {
    const closures = [{ from: 0, to: 2, since: SEVEN - 3600 }]
    const low = leg({ awaited: { report: 'landing', due: SEVEN + 600 }, energy_kwh: 133 })
    expect(alerts({ closures, legs: [low] }).map(({ matter }) => matter.kind)).toEqual([
      'low_charge',
      'closed',
    ])
    const below = leg({ awaited: { report: 'landing', due: SEVEN + 600 }, lands_with_kwh: -3 })
    expect(alerts({ chargesAsNeeded: true, closures, legs: [below] })[0]?.severity).toBe('critical')
  })
})

describe('the headline', () => {
  it('is no full vertiport, which stays in the list', () => {
    const full = alerts({ taken: [0, 6, 0] })
    expect(headlineOf(listed(full, []))).toBeUndefined()
    expect(full.map(({ matter }) => matter.kind)).toEqual(['full'])
  })

  it('is the first alert that was not acknowledged by any user', () => {
    const outages = [
      { aircraft: 0, since: SEVEN - 60 },
      { aircraft: 1, since: SEVEN - 30 },
    ]
    const found = alerts({ outages })
    const by = { seq: 7, actor: 'anna', time: '07:00:00' }
    const all = listed(found, [{ ...by, alert: found[0]?.key ?? '' }])
    expect(headlineOf(all)?.key).toBe(found[1]?.key)
    expect(all.at(-1)).toMatchObject({ key: found[0]?.key, acknowledgedBy: 'anna' })
    // The same alert at a later time is a new one.
    const again = alerts({ outages: [{ aircraft: 0, since: SEVEN - 1 }] })
    expect(listed(again, [{ ...by, alert: found[0]?.key ?? '' }])[0]?.acknowledgedBy).toBeUndefined()
  })
})
