// Moves the selection with keys: along the legs of an aircraft, and to the next aircraft at the
// same time.

import { at } from '../model/arrays'
import type { DayRecord, LegRecord, Seconds } from '../model/record'
import { aircraftMeant, type Target } from '../model/target'

export type Step = 'former' | 'next' | 'first' | 'last' | 'above' | 'below'

/**
 * The target of a step. Without a selection it starts with the first aircraft, at the displayed
 * time.
 */
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

/** The leg of an aircraft at a time; otherwise its first leg, or the aircraft if it has no leg. */
function legAt(record: DayRecord, aircraft: number, time: Seconds): Target | undefined {
  if (record.aircraft.length === 0) return undefined
  const legs = legsOf(record, aircraft)
  const leg = legs.findLast((one) => one.decided <= time) ?? legs[0]
  return leg === undefined ? { kind: 'aircraft', aircraft } : { kind: 'leg', aircraft, decided: leg.decided }
}

function legsOf(record: DayRecord, aircraft: number): LegRecord[] {
  return record.legs.filter((leg) => leg.aircraft === aircraft)
}

/** The selected leg; undefined if an aircraft or a vertiport is selected. */
export function selectedLeg(record: DayRecord, target: Target | undefined): LegRecord | undefined {
  if (target?.kind !== 'leg') return undefined
  return record.legs.find((leg) => leg.aircraft === target.aircraft && leg.decided === target.decided)
}

/** Whether a target is the leg at a position of the record. */
export function isOfLeg(record: DayRecord, leg: number, target: Target | undefined): boolean {
  if (target?.kind !== 'leg' || leg < 0) return false
  const { aircraft, decided } = at(record.legs, leg)
  return aircraft === target.aircraft && decided === target.decided
}
