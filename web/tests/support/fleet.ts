// A fleet that flies as expected: it reports departures and landings, and leaves decisions to the
// console.

import type {
  AircraftState,
  DayInfo,
  DayList,
  DayState,
  Event,
  NewDay,
  TakenEvent,
} from '../../src/api/types'
import { clock, timeOf } from '../../src/model/time'

/** A small network: fast to play, and with vertiports that fill up. */
export const smallNetwork = `
format = "vertifleet-network/1"
name = "small"
start_positions = "random"
[operations]
start = "06:00:00"
end = "10:00:00"
takeoff_s = 600
landing_s = 600
hold_s = 900
[[vertiports]]
id = "North"
x_mi = 10
y_mi = 30
stands = 3
busy = true
[[vertiports]]
id = "East"
x_mi = 30
y_mi = 12
stands = 3
busy = false
[[vertiports]]
id = "South"
x_mi = 8
y_mi = 2
stands = 2
busy = true
[[aircraft_types]]
id = "cityairbus"
seats = 4
speed_mph = 74.5
battery_kwh = 110
energy_kwh_per_mi = 2.2
charge_kw = 150
self_discharge_per_h = 0
[[fleet]]
type = "cityairbus"
count = 6
[tariffs]
passenger_cost_usd_per_mi = 0.64
fare_base = 2
fare_demand_weight = 0.5
energy_price_usd_per_kwh = 0.2
[uniform_demand]
periods = ["06:00:00", "07:00:00", "08:00:00", "09:00:00"]
least = 4
most = 30
`

/** The same on a disturbed day: late take-offs, a closure, and aircraft out of service. */
export const disturbedNetwork = `${smallNetwork}
[disturbances.takeoff_delays]
slot_s = 900
vertiports = [
    { at = "North", probability = 0.5, mean_s = 300, most_s = 900 },
    { at = "East", probability = 0.2, mean_s = 300, most_s = 900 },
    { at = "South", probability = 0.2, mean_s = 300, most_s = 900 },
]
[[disturbances.closures]]
probability = 1
least_s = 1800
most_s = 3600
routes = [{ from = "North", to = "South", both_ways = true }]
[disturbances.outages]
probability = 0.3
least_s = 1800
most_s = 3600
`

export class Fleet {
  constructor(
    private readonly url: string,
    readonly day: string,
    private readonly token?: string,
  ) {}

  /** A day of the small network. */
  static async onSmallDay(url: string, token?: string): Promise<Fleet> {
    await new Fleet(url, '', token).ask('PUT', '/v1/networks/small', { toml: smallNetwork })
    return Fleet.onNewDay(url, { network: 'small', seed: 2, policy: 'prices' }, token)
  }

  static async onNewDay(url: string, asked: NewDay, token?: string): Promise<Fleet> {
    const day = (await new Fleet(url, '', token).ask('POST', '/v1/days', asked)) as DayInfo
    return new Fleet(url, day.id, token)
  }

  /** The day that another user creates, as soon as it exists. */
  static async onDayOfOthers(url: string): Promise<Fleet> {
    for (;;) {
      const { days } = (await new Fleet(url, '').ask('GET', '/v1/days')) as DayList
      const [day] = days
      if (day !== undefined) return new Fleet(url, day.id)
      await new Promise((resume) => setTimeout(resume, 50))
    }
  }

  async ask(method: string, path: string, body?: unknown): Promise<unknown> {
    const text = await this.text(path, method, body)
    return text === '' ? undefined : (JSON.parse(text) as unknown)
  }

  /** The answer to a request as text. */
  async text(path: string, method = 'GET', body?: unknown): Promise<string> {
    const answer = await fetch(this.url + path, {
      method,
      headers: this.token === undefined ? {} : { Authorization: `Bearer ${this.token}` },
      ...(body === undefined ? {} : { body: JSON.stringify(body) }),
    })
    const text = await answer.text()
    if (!answer.ok) throw new Error(`${method} ${path}: ${text}`)
    return text
  }

  async state(): Promise<DayState> {
    return (await this.ask('GET', `/v1/days/${this.day}/state`)) as DayState
  }

  /** The number of decisions taken. */
  async decisions(): Promise<number> {
    return (await this.state()).totals.decisions
  }

  async events(): Promise<TakenEvent[]> {
    return ((await this.ask('GET', `/v1/days/${this.day}/events`)) as { events: TakenEvent[] }).events
  }

  async report(...events: Event[]): Promise<void> {
    await this.ask('POST', `/v1/days/${this.day}/events`, events)
  }

  /** The aircraft that wait for a decision. */
  async waiting(): Promise<string[]> {
    const { aircraft } = await this.state()
    return aircraft.filter((one) => one.needs_decision).map((one) => one.id)
  }

  /** Plays with the policy's decisions until a time at which no aircraft waits. */
  async playUntil(time: string): Promise<void> {
    while (await this.goOn()) {
      const { now } = await this.state()
      if (timeOf(now) >= timeOf(time)) return
      for (const aircraft of await this.waiting()) await this.decide(aircraft)
    }
  }

  /** Plays to the end with the policy's decisions. */
  async playToTheEnd(): Promise<void> {
    while (await this.goOn()) for (const aircraft of await this.waiting()) await this.decide(aircraft)
  }

  async decide(aircraft: string, more: object = {}): Promise<void> {
    await this.ask('POST', `/v1/days/${this.day}/decisions`, { aircraft, ...more })
  }

  /** Plays until an aircraft waits for a decision; false if none will. */
  async goOn(): Promise<boolean> {
    for (;;) {
      const state = await this.state()
      if (state.aircraft.some((one) => one.needs_decision)) return true
      // An aircraft that waits for charge departs later.
      const sentOff = state.aircraft.filter(
        (one) => one.phase === 'sent_off' && takeoffOf(one) <= timeOf(state.now),
      )
      await this.#report(
        sentOff.map((one) => ({ type: 'departed', aircraft: one.id, time: clock(takeoffOf(one)) })),
      )
      const next = nextOf(state)
      if (next === undefined) return false
      await this.report(next)
    }
  }

  async #report(events: Event[]): Promise<void> {
    if (events.length > 0) await this.report(...events)
  }
}

/** When an aircraft that was sent off takes off: at its decision, or when its charge suffices. */
function takeoffOf({ flight }: AircraftState): number {
  return timeOf(flight?.takeoff ?? flight?.decided ?? 0)
}

/** The next event if all goes as expected; undefined if all aircraft stand until the end. */
function nextOf(state: DayState): Event | undefined {
  const now = timeOf(state.now)
  const departures = state.aircraft
    .filter((one) => one.phase === 'sent_off' && takeoffOf(one) > now)
    .map((one) => ({ at: takeoffOf(one), event: { type: 'departed', aircraft: one.id } as const }))
  const landings = state.aircraft
    .filter((one) => one.phase !== 'standing')
    .map((one) => ({
      at: Math.max(now, timeOf(one.arrival)),
      event: { type: 'landed', aircraft: one.id } as const,
    }))
  const charged = state.aircraft
    .filter((one) => one.phase === 'standing' && timeOf(one.ready) > now)
    .map((one) => ({ at: timeOf(one.ready), event: { type: 'clock' } as const }))
  const [first] = [...departures, ...landings, ...charged].sort((one, other) => one.at - other.at)
  return first === undefined ? undefined : { ...first.event, time: clock(first.at) }
}
