// A day that goes otherwise than planned, event by event, the same for each seed: late departures,
// diversions, other passengers, aircraft that are reported elsewhere, and closures that change.

import type { DayState, Event } from '../../src/api/types'
import { clock, timeOf } from '../../src/model/time'
import type { Fleet } from './fleet'

/** Numbers in [0, 1) from a seed: the generator of Park and Miller. */
export function randomFrom(seed: number): () => number {
  let state = (seed * 48_271) % 2_147_483_647
  return () => (state = (state * 48_271) % 2_147_483_647) / 2_147_483_647
}

/** Takes the next decision or reports the next event; false at the end of the day. */
export async function step(fleet: Fleet, random: () => number): Promise<boolean> {
  const state = await fleet.state()
  const waiting = state.aircraft.find((one) => one.needs_decision)
  if (waiting !== undefined) {
    await fleet.decide(waiting.id)
    return true
  }
  const event = nextEvent(state, random)
  if (event === undefined) return false
  try {
    await fleet.report(event)
  } catch {
    // A report that the service refuses changes nothing; the day goes on by the clock.
    await fleet.report({ type: 'clock', time: clock(timeOf(state.now) + 60) })
  }
  return true
}

function nextEvent(state: DayState, random: () => number): Event | undefined {
  const now = timeOf(state.now)
  const ids = state.vertiports.map(({ id }) => id)
  const pick = <T>(list: readonly T[]): T => list[Math.floor(random() * list.length)] as T
  const chance = random()
  const standing = state.aircraft.filter(({ phase }) => phase === 'standing')
  if (chance < 0.02 && standing.length > 0)
    return { type: 'landed', aircraft: pick(standing).id, at: pick(ids) }
  if (chance < 0.06) return closureOf(state, random)
  const events = state.aircraft.flatMap((one): { at: number; event: Event }[] => {
    const { id: aircraft, phase } = one
    if (phase === 'standing')
      return timeOf(one.ready) > now ? [{ at: timeOf(one.ready), event: { type: 'clock' } }] : []
    if (phase === 'in_the_air') {
      const place = random() < 0.1 ? { at: pick(ids) } : {}
      return [{ at: timeOf(one.arrival), event: { type: 'landed', aircraft, ...place } }]
    }
    const more = random() < 0.2 ? { passengers: 1 } : random() < 0.1 ? { to: pick(ids) } : {}
    const takeoff = timeOf(one.flight?.takeoff ?? one.flight?.decided ?? 0)
    return [{ at: takeoff + Math.floor(random() * 400), event: { type: 'departed', aircraft, ...more } }]
  })
  const [first] = events.sort((one, other) => one.at - other.at)
  return first === undefined ? undefined : { ...first.event, time: clock(Math.max(now, first.at)) }
}

/**
 * A random event of any type, likely or not, with and without a time: half of them the service
 * refuses.
 */
export function anyEvent(state: DayState, random: () => number): Event {
  const now = timeOf(state.now)
  const pick = <T>(list: readonly T[]): T => list[Math.floor(random() * list.length)] as T
  const place = () => pick(state.vertiports).id
  const soon = (most_s: number) => clock(now + Math.floor(random() * most_s))
  const maybe = <T extends object>(share: number, more: T): Partial<T> => (random() < share ? more : {})
  const late = maybe(0.3, { time: clock(Math.max(0, now + Math.floor(random() * 900 - 450))) })
  const of = (phase: string) => {
    const those = state.aircraft.filter((one) => one.phase === phase)
    return pick(random() < 0.85 && those.length > 0 ? those : state.aircraft).id
  }
  const waiting = state.aircraft.filter((one) => one.needs_decision)
  if (waiting.length > 0 && random() < 0.35)
    return { type: 'decided', aircraft: pick(waiting).id, to: place() }
  const kinds: (() => Event)[] = [
    () => ({ type: 'departed', aircraft: of('sent_off'), ...maybe(0.4, { to: place() }), ...late }),
    () => ({ type: 'departed', aircraft: of('sent_off'), ...late }),
    () => ({ type: 'landed', aircraft: of('in_the_air'), ...maybe(0.3, { at: place() }), ...late }),
    () => ({ type: 'landed', aircraft: of('in_the_air'), ...late }),
    () => ({ type: 'landed', aircraft: of('standing'), at: place() }),
    () => ({ type: 'undone', aircraft: of('sent_off') }),
    () => ({ type: 'delayed', aircraft: of('sent_off'), until: soon(1_800), ...late }),
    () => ({ type: 'charging', aircraft: of('standing'), ready: soon(1_800), ...late }),
    () => ({ type: 'ready', aircraft: of('standing'), ...late }),
    () => ({
      type: 'out_of_service',
      aircraft: of('sent_off'),
      ...maybe(0.6, { until: soon(3_600) }),
      ...late,
    }),
    () => ({ type: 'back_in_service', aircraft: of('standing'), ...late }),
    () => ({ ...closureOf(state, random), ...late }),
    () => ({ type: 'stands', vertiport: place(), stands: Math.floor(6 * random()), ...late }),
    () => ({ type: 'acknowledged', alert: 'an alert', ...maybe(0.5, { time: soon(1_200) }) }),
    () => ({ type: 'corrected', event: 1 + Math.floor(random() * state.seq) }),
    () => ({ type: 'clock', time: soon(900) }),
  ]
  return pick(kinds)()
}

/** A random report about the routes of a vertiport, or about one of them. */
export function closureOf(state: DayState, random: () => number): Event {
  const pick = () => state.vertiports[Math.floor(random() * state.vertiports.length)]?.id ?? ''
  const [from, to, chance] = [pick(), pick(), random()]
  const routes = from === to ? { vertiport: from } : { from, to }
  if (chance < 0.3) return { type: 'reopened', routes }
  const until = clock(timeOf(state.now) + 600 * Math.floor(12 * random()))
  return { type: 'closed', routes, ...(chance < 0.8 ? { until } : {}) }
}
