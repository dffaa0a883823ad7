// A fleet that flies as it is expected to: it reports departures and landings, and leaves decisions to the console.

import type { DayState, Event, TakenEvent } from '../../src/api/types'
import { clock, timeOf } from '../../src/model/time'

/** A small network: quickly played, and with vertiports that fill up. */
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

export class Fleet {
  constructor(
    private readonly url: string,
    readonly day: string,
    private readonly token?: string,
  ) {}

  /** A day of the small network. */
  static async onSmallDay(url: string, token?: string): Promise<Fleet> {
    const maker = new Fleet(url, '', token)
    await maker.ask('PUT', '/v1/networks/small', { toml: smallNetwork })
    const day = (await maker.ask('POST', '/v1/days', { network: 'small', seed: 2, policy: 'prices' })) as {
      id: string
    }
    return new Fleet(url, day.id, token)
  }

  async ask(method: string, path: string, body?: unknown): Promise<unknown> {
    const answer = await fetch(this.url + path, {
      method,
      headers: this.token === undefined ? {} : { Authorization: `Bearer ${this.token}` },
      ...(body === undefined ? {} : { body: JSON.stringify(body) }),
    })
    const text = await answer.text()
    if (!answer.ok) throw new Error(`${method} ${path}: ${text}`)
    return text === '' ? undefined : (JSON.parse(text) as unknown)
  }

  async state(): Promise<DayState> {
    return (await this.ask('GET', `/v1/days/${this.day}/state`)) as DayState
  }

  async events(): Promise<TakenEvent[]> {
    return ((await this.ask('GET', `/v1/days/${this.day}/events`)) as { events: TakenEvent[] }).events
  }

  async report(...events: Event[]): Promise<void> {
    await this.ask('POST', `/v1/days/${this.day}/events`, events)
  }

  async decide(aircraft: string, more: object = {}): Promise<void> {
    await this.ask('POST', `/v1/days/${this.day}/decisions`, { aircraft, ...more })
  }

  /** Goes on until somebody waits for a decision; false when nobody will any more. */
  async goOn(): Promise<boolean> {
    for (;;) {
      const state = await this.state()
      if (state.aircraft.some((one) => one.needs_decision)) return true
      const sentOff = state.aircraft.filter((one) => one.phase === 'sent_off')
      await this.#report(
        sentOff.map((one) => ({ type: 'departed', aircraft: one.id, time: one.flight?.decided ?? null })),
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

/** What happens next if all goes as it is expected to; undefined if all aircraft stand for good. */
function nextOf(state: DayState): Event | undefined {
  const now = timeOf(state.now)
  const landings = state.aircraft
    .filter((one) => one.phase !== 'standing')
    .map((one) => ({
      at: Math.max(now, timeOf(one.arrival)),
      event: { type: 'landed', aircraft: one.id } as const,
    }))
  const charged = state.aircraft
    .filter((one) => one.phase === 'standing' && timeOf(one.ready) > now)
    .map((one) => ({ at: timeOf(one.ready), event: { type: 'clock' } as const }))
  const [first] = [...landings, ...charged].sort((one, other) => one.at - other.at)
  return first === undefined ? undefined : { ...first.event, time: clock(first.at) }
}
