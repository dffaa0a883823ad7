// Moving the selection with keys: along the legs of an aircraft, and from one aircraft to the next at the same time.

import { at } from '../model/arrays'
import type { DayRecord, LegRecord, Seconds } from '../model/record'
import { aircraftMeant, type Target } from '../model/target'

export type Step = 'former' | 'next' | 'first' | 'last' | 'above' | 'below'

/** What a step leads to. Without a selection it begins with the first aircraft, at the time that is shown. */
export function stepFrom(
  record: DayRecord,
  selected: Target | undefined,
  time: Seconds,
  step: Step,
): Target | undefined {
  const aircraft = aircraftMeant(selected)
  if (aircraft === undefined) return legAt(record, 0, time)
  const current = selected?.kind === 'leg' ? selected.decided : time
  if (step === 'above' || step === 'below') {
    const other = aircraft + (step === 'above' ? -1 : 1)
    return other < 0 || other >= record.aircraft.length ? selected : legAt(record, other, current)
  }
  const legs = legsOf(record, aircraft)
  const position = legs.findLastIndex((leg) => leg.decided <= current)
  const wanted = { former: position - 1, next: position + 1, first: 0, last: legs.length - 1 }[step]
  const leg = legs[Math.max(0, Math.min(legs.length - 1, wanted))]
  return leg === undefined ? selected : { kind: 'leg', aircraft, decided: leg.decided }
}

/** The leg that an aircraft is on at a time, the first one before it, and the aircraft itself if it has none. */
function legAt(record: DayRecord, aircraft: number, time: Seconds): Target | undefined {
  if (record.aircraft.length === 0) return undefined
  const legs = legsOf(record, aircraft)
  const leg = legs.findLast((one) => one.decided <= time) ?? legs[0]
  return leg === undefined ? { kind: 'aircraft', aircraft } : { kind: 'leg', aircraft, decided: leg.decided }
}

function legsOf(record: DayRecord, aircraft: number): LegRecord[] {
  return record.legs.filter((leg) => leg.aircraft === aircraft)
}

/** The leg that is selected; undefined for an aircraft or a vertiport. */
export function selectedLeg(record: DayRecord, target: Target | undefined): LegRecord | undefined {
  if (target?.kind !== 'leg') return undefined
  return record.legs.find((leg) => leg.aircraft === target.aircraft && leg.decided === target.decided)
}

/** A leg's position among all, by its target. */
export function isOfLeg(record: DayRecord, leg: number, target: Target | undefined): boolean {
  if (target?.kind !== 'leg' || leg < 0) return false
  const { aircraft, decided } = at(record.legs, leg)
  return aircraft === target.aircraft && decided === target.decided
}
