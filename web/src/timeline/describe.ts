// Describes a bar of a timeline, line by line, the name first.

import { at } from '../model/arrays'
import { minutesOverdue } from '../model/awaited'
import type { Bar } from '../model/bars'
import type { DifferingLegs } from '../model/differ'
import { count, dollarsAndCents } from '../model/money'
import { isHold, type DayRecord, type LegRecord } from '../model/record'
import { clock } from '../model/time'
import { text } from '../text/text'

/** Another play of the same day, for comparison with a timeline. */
export interface OtherPlay {
  title: string
  /** The legs of this play that the other one lacks. */
  differing: DifferingLegs
}

export function describeBar(record: DayRecord, bar: Bar, otherPlay?: OtherPlay): string[] {
  const { id } = at(record.aircraft, bar.aircraft)
  const isEndless = bar.ends === Infinity
  const begins = clock(Math.max(bar.begins, record.start))
  const times = isEndless ? text.timeline.since(begins) : text.timeline.times(begins, clock(bar.ends))
  const leg = record.legs[bar.leg]
  const own = [`${text.timeline.kinds[bar.kind]} ${times}`, ...chargeOf(record, bar)].join(', ')
  return leg === undefined
    ? [id, own]
    : [`${id} · ${nameOf(record, leg)}`, own, ...details(record, leg, otherPlay)]
}

/** The charge at the beginning and the end of a bar, on a day that charges as needed. */
function chargeOf({ aircraft }: DayRecord, { charge, aircraft: one }: Bar): string[] {
  if (charge === undefined) return []
  const { battery_kwh } = at(aircraft, one)
  const [begins, ends] = [charge.begins * battery_kwh, charge.ends * battery_kwh]
  return [text.timeline.charges(count(begins), count(ends))]
}

/** A leg in one sentence, for screen readers. */
export function describeLeg(record: DayRecord, leg: LegRecord, otherPlay?: OtherPlay): string {
  const { id } = at(record.aircraft, leg.aircraft)
  const times = text.timeline.times(
    clock(isHold(leg) ? leg.decided : leg.departs),
    clock(isHold(leg) ? leg.ready : leg.arrives),
  )
  return [`${id} ${nameOf(record, leg)}`, times, ...details(record, leg, otherPlay)].join(', ')
}

export function nameOf({ vertiports }: DayRecord, leg: LegRecord): string {
  const [from, to] = [at(vertiports, leg.from).id, at(vertiports, leg.to).id]
  return isHold(leg) ? text.timeline.hold(from) : text.timeline.flight(from, to)
}

/** Whether a leg is overdue or expected, and its counterpart in another play. */
export function notesOf(record: DayRecord, leg: LegRecord, otherPlay?: OtherPlay): string[] {
  const position = otherPlay === undefined ? -1 : record.legs.indexOf(leg)
  const isDiffering = otherPlay?.differing.has(position) ?? false
  const overdue_min = minutesOverdue(leg)
  return [
    ...(overdue_min > 0 ? [text.map.overdueBy(overdue_min)] : []),
    ...(leg.is_expected ? [text.timeline.expected] : []),
    ...(isDiffering && otherPlay !== undefined ? [insteadOf(record, otherPlay, position)] : []),
  ]
}

function insteadOf(record: DayRecord, { title, differing }: OtherPlay, position: number): string {
  const twin = differing.get(position)?.twin
  if (twin === undefined) return text.timeline.nothingThere(title)
  const load = isHold(twin) ? undefined : twin.passengers
  return text.timeline.differs(title, nameOf(record, twin), clock(twin.decided), load)
}

function details(record: DayRecord, leg: LegRecord, otherPlay: OtherPlay | undefined): string[] {
  const lines: string[] = []
  if (!isHold(leg)) {
    const load = text.timeline.passengers(leg.passengers, at(record.aircraft, leg.aircraft).seats)
    lines.push(`${load} · ${dollarsAndCents(leg.profit_usd)}`, text.timeline.ready(clock(leg.ready)))
  }
  if (leg.planned !== undefined) {
    const { departs, arrives, ready } = leg.planned
    lines.push(text.timeline.planned(clock(departs), clock(arrives), clock(ready)))
  }
  if (!leg.is_expected && leg.policy !== undefined) lines.push(text.timeline.decidedBy(leg.policy))
  return [...lines, ...notesOf(record, leg, otherPlay)]
}
