// Describes the object under the pointer on the map, line by line, the name first.

import { at } from '../model/arrays'
import { latenessOf, minutesOverdue } from '../model/awaited'
import { isHold, type LegRecord, type Seconds } from '../model/record'
import { count, percent } from '../model/money'
import { NONE, Phase } from '../model/motion'
import type { Target } from '../model/target'
import { clock, clockMinutes } from '../model/time'
import { text } from '../text/text'
import type { Scene } from './scene'

const phaseNames: Record<Phase, keyof typeof text.map.phases> = {
  [Phase.waiting]: 'waiting',
  [Phase.charging]: 'charging',
  [Phase.holding]: 'holding',
  [Phase.delayed]: 'delayed',
  [Phase.flying]: 'flying',
  [Phase.out]: 'out',
}

export function describe(scene: Scene, target: Target): string[] {
  return target.kind === 'vertiport'
    ? describeVertiport(scene, target.vertiport)
    : describeAircraft(scene, target.aircraft)
}

function describeAircraft({ record, frame, fleet }: Scene, aircraft: number): string[] {
  const { id, type, seats, battery_kwh } = at(record.aircraft, aircraft)
  const phase = at(frame.phases, aircraft) as Phase
  const leg = record.legs[at(frame.legs, aircraft)]
  const stands = at(frame.stands, aircraft)
  const place = stands === NONE ? '' : ` ${text.map.at(at(record.vertiports, stands).id)}`
  const lines = [text.map.aircraftOfType(id, type), `${phaseOf(leg, phase, frame.time)}${place}`]
  if (leg !== undefined)
    lines.push(
      ...describeLeg(
        leg,
        phase,
        frame.time,
        record.vertiports.map((one) => one.id),
        seats,
      ),
    )
  const share = at(frame.charges, aircraft)
  if (record.chargesAsNeeded !== true) return [...lines, text.map.charge(percent(share))]
  if (phase !== Phase.flying)
    return [...lines, text.map.chargeOf(count(share * battery_kwh), count(battery_kwh))]
  const landing = fleet.charges.arriving(at(frame.legs, aircraft))
  return [...lines, text.aircraft.landsWith(count(landing * battery_kwh))]
}

/**
 * What an aircraft does. One that waits for charge is not delayed, and one that was dispatched is
 * only when it is to leave later than decided.
 */
function phaseOf(leg: LegRecord | undefined, phase: Phase, time: Seconds): string {
  if (phase === Phase.delayed && leg?.charged !== undefined && time < leg.charged)
    return text.map.chargesForFlight
  if (phase === Phase.delayed && leg !== undefined && !isDelayed(leg, time)) return text.map.dispatched
  return text.map.phases[phaseNames[phase]]
}

function isDelayed(leg: LegRecord, time: Seconds): boolean {
  return leg.departs > (leg.charged ?? leg.decided) || minutesOverdue(leg, time) > 0
}

function describeLeg(leg: LegRecord, phase: Phase, time: Seconds, names: string[], seats: number): string[] {
  if (phase === Phase.holding) return [text.map.holdsUntil(clockMinutes(leg.ready))]
  if (phase === Phase.charging || phase === Phase.out) return [text.map.readyAt(clockMinutes(leg.ready))]
  if (phase === Phase.waiting || isHold(leg)) return []
  const load = leg.passengers === 0 ? text.map.empty : text.map.seats(leg.passengers, seats)
  const route = text.map.from(at(names, leg.from), at(names, leg.to))
  return [route, `${load} · ${nextOf(leg, phase, time)}`, ...overdueOf(leg, time)]
}

/** When an aircraft takes off or lands, or when it should have. */
function nextOf(leg: LegRecord, phase: Phase, time: Seconds): string {
  if (leg.awaited !== undefined && latenessOf(leg, time) > 0)
    return text.map.due[leg.awaited.report](clock(leg.awaited.due))
  return phase === Phase.delayed ? text.map.takesOff(clock(leg.departs)) : text.map.lands(clock(leg.arrives))
}

function overdueOf(leg: LegRecord, time: Seconds): string[] {
  const minutes = minutesOverdue(leg, time)
  return minutes === 0 ? [] : [text.map.overdueBy(minutes)]
}

function describeVertiport(scene: Scene, vertiport: number): string[] {
  const { taken, promised, overdue } = scene.counts.standsOf(vertiport)
  const lines = [
    at(scene.record.vertiports, vertiport).id,
    text.map.stands(taken, promised, at(scene.room, vertiport)),
  ]
  if (overdue > 0) lines.push(text.map.overdue(overdue))
  const sum = (end: 'from' | 'to') =>
    scene.allPairs.filter((pair) => pair[end] === vertiport).reduce((all, pair) => all + pair.passengers, 0)
  if (scene.allPairs.length > 0)
    lines.push(`${text.map.waitingFrom(sum('from'))} · ${text.map.waitingTo(sum('to'))}`)
  const isClosed = scene.closures.some((one) => 'vertiport' in one && one.vertiport === vertiport)
  if (isClosed) lines.push(text.map.vertiportClosed)
  return lines
}

/** Describes the map in one sentence for users who cannot see it. */
export function summarise(scene: Scene, time: number): string {
  const { record, frame, counts, closures } = scene
  const overdue = record.aircraft.flatMap(({ id }, one) => {
    const minutes = at(frame.overdue_min, one)
    return minutes === 0 ? [] : [text.map.overdueOne(id, minutes)]
  })
  const parts = [text.map.inTheAir(counts.inTheAir), ...overdue, text.map.closed(closures.length)].join(', ')
  const what = text.map.summary(
    text.map.vertiports(record.vertiports.length),
    text.map.aircraft(record.aircraft.length),
  )
  return `${what} ${text.map.summaryAt(clockMinutes(time), parts)}`
}
