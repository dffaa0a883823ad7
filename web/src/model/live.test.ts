import { describe, expect, it } from 'vitest'
import type { AircraftState, DayState, Leg, Outlook, TakenEvent } from '../api/types'
import { fleetRows } from './bars'
import {
  decided,
  east,
  events,
  north,
  outlook,
  recordAfter,
  scenario,
  south,
  state,
} from './fixtures/liveDay'
import { legsOf } from './expectedLegs'
import { liveRecord } from './live'
import { isHold, type LegRecord } from './record'
import { Reports } from './reports'
import { clock, timeOf } from './time'

const [a01, a02, a03, a04, a05] = [0, 1, 2, 3, 4]

const record = recordAfter()
const taken = (aircraft: number) => record.legs.filter((leg) => leg.aircraft === aircraft && !leg.is_expected)

describe('a live day that charges as needed', () => {
  const asNeeded = { ...scenario, operations: { ...scenario.operations, charging: 'as_needed' as const } }
  const decided: TakenEvent[] = [
    { seq: 1, event: { type: 'decided', time: '06:47:00', aircraft: 'A03', to: 'North' } },
  ] as unknown as TakenEvent[]

  /** The flight of A03, whose charge suffices twelve minutes after its decision. */
  function flightOfA03(events = decided) {
    const reports = new Reports(asNeeded)
    for (const event of events) reports.take(event)
    const aircraft = state.aircraft
      .filter(({ id }) => id === 'A03')
      .map((one): AircraftState => {
        const flight = { from: 'East', to: 'North', passengers: 4, decided: '06:47:00', takeoff: '06:59:00' }
        return { ...one, phase: 'sent_off', arrival: '07:44:21', lands_with_kwh: 12, flight }
      })
    const { legs } = liveRecord({
      ...{ scenario: asNeeded, reports, state: { ...state, aircraft }, outlook: undefined, decided: [] },
    })
    return legs.find((leg) => leg.aircraft === a03)
  }

  it('departs when the charge suffices', () => {
    const flight = flightOfA03()
    const takeoff = timeOf('06:59:00')
    expect(flight).toMatchObject({
      decided: timeOf('06:47:00'),
      ...{ charged: takeoff, departs: takeoff, lands_with_kwh: 12 },
      awaited: { report: 'departure', due: takeoff },
    })
  })

  it('has the charge of a reported landing', () => {
    const landed = [
      { seq: 2, event: { type: 'departed', time: '06:59:00', aircraft: 'A03' } },
      { seq: 3, event: { type: 'landed', time: '07:40:00', aircraft: 'A03', charge_kwh: 9.5 } },
    ] as unknown as TakenEvent[]
    expect(flightOfA03([...decided, ...landed])?.lands_with_kwh).toBe(9.5)
  })

  describe('with a late departure', () => {
    const late = ['charge 06:47:00-06:59:00', 'delay 06:59:00-07:10:00', 'flight 07:10:00-07:51:40']
    const departed = { seq: 2, event: { type: 'departed', time: '07:10:00', aircraft: 'A03' } }
    const times = { arrival: '07:51:40', ready: '07:51:40' }
    const flight = { from: 'East', to: 'North', passengers: 4, decided: '06:47:00', takeoff: '06:59:00' }
    const after = (change: Partial<AircraftState>): DayState => ({
      ...state,
      aircraft: state.aircraft.map((one) => (one.id === 'A03' ? { ...one, ...times, ...change } : one)),
    })
    const flying = after({ phase: 'in_the_air', flight })

    function barsOfA03(now: DayState): string[] {
      const reports = new Reports(asNeeded)
      for (const event of [...decided, departed as unknown as TakenEvent]) reports.take(event)
      const isFlight = (leg: Leg) => leg.aircraft === 'A03' && leg.time === '06:47:00'
      const legs = outlook.legs.map((leg) =>
        isFlight(leg) ? { ...leg, ...times, takeoff: '06:59:00' } : leg,
      )
      const given = { ...outlook, legs }
      const taken = legsOf(given, asNeeded).filter((leg) => !leg.is_expected)
      const sources = { scenario: asNeeded, reports, outlook: given, decided: taken }
      const record = liveRecord({ ...sources, state: now })
      const bars = fleetRows(record)[a03]?.bars.filter(({ begins }) => begins >= timeOf('06:47:00')) ?? []
      return bars.map(({ kind, begins, ends }) => `${kind} ${clock(begins)}-${clock(ends)}`)
    }

    it('charges until the take-off that was decided, and is late from then on', () => {
      expect(barsOfA03(flying).slice(0, 3)).toEqual(late)
    })

    it('is drawn the same after its landing', () => {
      const landed = after({ phase: 'standing', place: 'North', flight: null })
      expect(barsOfA03(landed).slice(0, 3)).toEqual(late)
    })
  })

  it('has the take-offs of the outlook', () => {
    const legs = outlook.legs.filter((leg) => leg.aircraft === 'A03' && leg.from !== leg.to)
    const later = (time: Leg['time']) => clock(timeOf(time) + 600)
    const waiting = legs.map((leg) => ({ ...leg, takeoff: later(leg.time), arrival: later(leg.arrival) }))
    const given = { ...outlook, legs: waiting }
    const all = legsOf(given, asNeeded)
    expect(all.length).toBeGreaterThan(1)
    for (const leg of all) {
      expect([leg.charged, leg.departs]).toEqual([leg.decided + 600, leg.decided + 600])
      expect(leg.energy_kwh).toBeGreaterThan(0)
    }
  })
})

describe('the record of a live day', () => {
  it('has every leg of the outlook, in the order of decisions', () => {
    expect(record.legs).toHaveLength(outlook.legs.length)
    const times = record.legs.map((leg) => leg.decided)
    expect(times).toEqual([...times].sort((one, other) => one - other))
    expect(record.legs.filter((leg) => leg.is_expected)).toHaveLength(
      outlook.legs.filter((leg) => !leg.is_taken).length,
    )
  })

  it('replaces plans by reports', () => {
    const [late] = taken(a02)
    expect(late).toMatchObject({
      from: north,
      to: south,
      departs: timeOf('06:11:30'),
      arrives: timeOf('06:54:06'),
    })
    expect(late?.planned?.departs).toBe(timeOf('06:00:00'))
    expect(late?.planned?.arrives).toBe(timeOf('06:42:36'))
    const [landed] = taken(a01)
    expect(landed).toMatchObject({ to: east, departs: timeOf('06:00:00'), arrives: timeOf('06:45:00') })
    expect(landed?.planned?.arrives).toBe(timeOf('06:41:40'))
  })

  it('contains holds, but no undone decisions', () => {
    const [hold, flight] = taken(a03)
    expect(hold !== undefined && isHold(hold)).toBe(true)
    expect(flight).toMatchObject({ from: east, to: north, departs: timeOf('06:47:00') })
    expect(flight?.planned).toBeUndefined()
    expect(taken(a03)).toHaveLength(2)
    expect(taken(a05)).toHaveLength(0)
  })

  it('has every decided leg from the state and the events alone', () => {
    const keyOf = ({ decided, aircraft, from, to, departs, arrives }: LegRecord) =>
      [aircraft, from, to, decided, departs, arrives].join()
    const { legs } = recordAfter(events, null, [])
    expect(legs.map(keyOf)).toEqual(record.legs.filter((leg) => !leg.is_expected).map(keyOf))
  })

  it('moves an aircraft that is reported elsewhere without a flight', () => {
    const aircraft = state.aircraft.map((one) => (one.id === 'A05' ? { ...one, place: 'East' } : one))
    const sources = { scenario, reports: new Reports(scenario), outlook: undefined, decided: [] }
    const { legs } = liveRecord({ ...sources, state: { ...state, aircraft } })
    expect(legs.filter((leg) => leg.aircraft === a05)).toMatchObject([{ from: east, to: east }])
  })

  it('writes no landing into an earlier leg', () => {
    // The trace and the events are older than the state, in which A01 has flown on and landed.
    const landing = events.findIndex(({ event }) => event.type === 'landed')
    const aircraft = state.aircraft.map((one) =>
      one.id === 'A01' ? { ...one, place: 'East', arrival: '08:30:00', ready: '08:50:00' } : one,
    )
    const reports = new Reports(scenario)
    for (const event of events.slice(0, landing + 1)) reports.take(event)
    const { legs } = liveRecord({
      scenario,
      reports,
      outlook: undefined,
      decided,
      state: { ...state, aircraft },
    })
    expect(legs.find((leg) => leg.aircraft === a01)?.arrives).toBe(timeOf('06:45:00'))
  })

  it('contains past flights before there is an outlook', () => {
    const flown = record.legs.filter((leg) => !leg.is_expected)
    const early = recordAfter(events, null, flown)
    expect(early.legs.map(({ decided, aircraft }) => [decided, aircraft])).toEqual(
      flown.map(({ decided, aircraft }) => [decided, aircraft]),
    )
  })

  it('drops expected legs of an aircraft that was decided after the outlook', () => {
    const older: Outlook = {
      ...outlook,
      legs: outlook.legs.filter((leg) => !(leg.aircraft === 'A03' && leg.is_taken)),
    }
    const legs = recordAfter(events, older).legs.filter((leg) => leg.aircraft === a03)
    const flight = legs.findIndex((leg) => leg.from !== leg.to)
    expect(legs[flight]).toMatchObject({ is_expected: false, to: north })
    expect(legs.slice(flight + 1).every((leg) => leg.decided >= timeOf('07:52:21'))).toBe(true)
  })

  it('drops an undone flight before there is another outlook', () => {
    const undone: DayState = {
      ...state,
      aircraft: state.aircraft.map((one) =>
        one.id === 'A03'
          ? { ...one, phase: 'standing', place: 'East', arrival: '06:00:00', flight: null }
          : one,
      ),
    }
    const isSentOff = (state: DayState) => {
      const { legs } = liveRecord({ scenario, reports: new Reports(scenario), state, outlook, decided })
      return legs.some((leg) => leg.aircraft === a03 && leg.to === north && !leg.is_expected)
    }
    expect(isSentOff(state)).toBe(true)
    expect(isSentOff(undone)).toBe(false)
  })

  it('contains outages with their ends', () => {
    expect(record.outages).toEqual([
      { aircraft: a04, since: timeOf('06:13:00'), until: timeOf('07:30:00'), reason: 'bird strike' },
    ])
  })

  it('splits a closed vertiport when one of its routes opens', () => {
    expect(recordAfter(events.slice(0, 10)).closures).toEqual([
      { vertiport: south, since: timeOf('06:20:00'), until: timeOf('08:00:00'), reason: 'fog' },
    ])
    const inForce = recordAfter(events.slice(0, 11)).closures.filter(
      (one) => (one.until ?? Infinity) > timeOf('06:30:00'),
    )
    const routes = inForce.map((one) => ('vertiport' in one ? 'all' : `${one.from}-${one.to}`))
    expect(routes.sort()).toEqual([`${north}-${south}`, `${east}-${south}`, `${south}-${east}`].sort())
  })

  it('counts passengers carried before a demand report', () => {
    expect(scenario.demand[0]?.[north]?.[east]).toBe(5)
    expect(record.demand?.passengers[0]?.[north]?.[east]).toBe(5 + 4)
    expect(record.demand?.passengers[1]?.[south]?.[north]).toBe(
      (scenario.demand[1]?.[south]?.[north] ?? 0) + 9,
    )
  })
})
