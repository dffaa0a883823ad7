// The selected object: an aircraft, one of its legs, or a vertiport. Lists, maps and timelines
// share one selection.

import type { Seconds } from './record'

/**
 * A leg is identified by its aircraft and the time of its decision, which stay the same when the
 * record is rebuilt.
 */
export type Target =
  | { kind: 'aircraft'; aircraft: number }
  | { kind: 'leg'; aircraft: number; decided: Seconds }
  | { kind: 'vertiport'; vertiport: number }

export function isSame(one: Target | undefined, other: Target | undefined): boolean {
  if (one === undefined || other === undefined) return one === other
  if (one.kind === 'vertiport') return other.kind === 'vertiport' && one.vertiport === other.vertiport
  if (other.kind === 'vertiport') return false
  if (one.kind === 'leg' && other.kind === 'leg' && one.decided !== other.decided) return false
  return one.kind === other.kind && one.aircraft === other.aircraft
}

/** The selected aircraft, either directly or through one of its legs. */
export function aircraftMeant(target: Target | undefined): number | undefined {
  return target === undefined || target.kind === 'vertiport' ? undefined : target.aircraft
}

/** The selected vertiport. */
export function vertiportMeant(target: Target | undefined): number | undefined {
  return target?.kind === 'vertiport' ? target.vertiport : undefined
}
