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

/** A random report about the routes of a vertiport, or about one of them. */
export function closureOf(state: DayState, random: () => number): Event {
  const pick = () => state.vertiports[Math.floor(random() * state.vertiports.length)]?.id ?? ''
  const [from, to, chance] = [pick(), pick(), random()]
  const routes = from === to ? { vertiport: from } : { from, to }
  if (chance < 0.3) return { type: 'reopened', routes }
  const until = clock(timeOf(state.now) + 600 * Math.floor(12 * random()))
  return { type: 'closed', routes, ...(chance < 0.8 ? { until } : {}) }
}
