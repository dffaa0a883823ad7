// The closures of a live day, route by route, by the rule of the service: the latest report about a
// route, in the order of the log, replaces every closure that is in force on it at the day's clock.
// Closures known in advance that begin later still begin.

import type { ClosureRecord, RouteRecord, Seconds } from './record'

/** One closed span of a one-way route. */
interface Span {
  since: Seconds
  /** Absent until a later report about the route. */
  until?: Seconds
  reason?: string
  /** The report that closed a whole vertiport together with its other routes. */
  whole?: { vertiport: number; seq: number }
}

/** What a report says about routes. */
export interface ClosureReport {
  seq: number
  at: Seconds
  until?: Seconds
  reason?: string
}

export type Routes = RouteRecord | { vertiport: number }

export class Closures {
  /** By the two ends of the route. */
  readonly #spans = new Map<string, Span[]>()
  #records: ClosureRecord[] | undefined

  constructor(
    private readonly vertiports: number,
    announced: readonly (RouteRecord & { since: Seconds; until: Seconds })[],
  ) {
    for (const { from, to, since, until } of announced) this.#of({ from, to }).push({ since, until })
  }

  /** Closes routes. `clock` is the time of the day, which includes that of the report. */
  close(routes: Routes, { seq, at, until, reason }: ClosureReport, clock: Seconds): void {
    const whole = 'vertiport' in routes ? { whole: { vertiport: routes.vertiport, seq } } : {}
    for (const route of this.#routesOf(routes)) {
      this.#open(route, clock, until === undefined || until > clock ? at : clock)
      if (until !== undefined && until <= clock) continue
      this.#of(route).push({
        since: at,
        ...(until === undefined ? {} : { until }),
        ...(reason === undefined ? {} : { reason }),
        ...whole,
      })
    }
    this.#records = undefined
  }

  reopen(routes: Routes, clock: Seconds): void {
    for (const route of this.#routesOf(routes)) this.#open(route, clock, clock)
    this.#records = undefined
  }

  /** Ends the spans of a route that are in force at the day's clock, at a time. */
  #open({ from, to }: RouteRecord, clock: Seconds, ends: Seconds): void {
    const ended = this.#of({ from, to }).map((span) =>
      isInForce(span, clock) ? { ...span, until: Math.max(span.since, ends) } : span,
    )
    this.#spans.set(
      key({ from, to }),
      ended.filter(({ since, until }) => until === undefined || until > since),
    )
  }

  /** All closures, past and known: those of a whole vertiport as one while its routes agree. */
  get records(): ClosureRecord[] {
    this.#records ??= this.#grouped()
    return this.#records
  }

  #grouped(): ClosureRecord[] {
    const wholes = new Map<string, { span: Span; routes: number }>()
    const all = [...this.#spans].flatMap(([name, spans]) => spans.map((span) => ({ name, span })))
    for (const { span } of all) {
      const id = wholeOf(span)
      if (id !== undefined) wholes.set(id, { span, routes: (wholes.get(id)?.routes ?? 0) + 1 })
    }
    const isWhole = (span: Span) => wholes.get(wholeOf(span) ?? '')?.routes === 2 * (this.vertiports - 1)
    const vertiports = [...wholes.values()].filter(({ span }) => isWhole(span))
    const single = all.filter(({ span }) => !isWhole(span))
    return [
      ...vertiports.map(({ span }) => recordOf({ vertiport: span.whole?.vertiport ?? 0 }, span)),
      ...single.map(({ name, span }) => recordOf(routeOf(name), span)),
    ].sort((one, other) => one.since - other.since)
  }

  #routesOf(routes: Routes): RouteRecord[] {
    return 'vertiport' in routes ? routesOf(routes.vertiport, this.vertiports) : [routes]
  }

  #of(route: RouteRecord): Span[] {
    const spans = this.#spans.get(key(route)) ?? []
    this.#spans.set(key(route), spans)
    return spans
  }
}

export function isInForce({ since, until }: { since: Seconds; until?: Seconds }, at: Seconds): boolean {
  return since <= at && (until === undefined || until > at)
}

type VertiportClosure = Extract<ClosureRecord, { vertiport: number }>

/**
 * Closures that are in force at the same time, with those of single routes joined where together
 * they close every route from and to a vertiport. A joined one lasts while all routes are closed.
 */
export function joined(inForce: readonly ClosureRecord[], vertiports: number): ClosureRecord[] {
  const ofRoutes = inForce.flatMap((one) => ('vertiport' in one ? [] : [one]))
  const ofVertiports = inForce.filter((one) => 'vertiport' in one)
  const alone = ofRoutes.map(endsOf)
  const isReported = (vertiport: number) => ofVertiports.some((one) => one.vertiport === vertiport)
  const found = Array.from({ length: vertiports }, (_, vertiport) => vertiport).flatMap(
    (vertiport): VertiportClosure[] => {
      const isStruck = alone.some((ends) => ends.includes(vertiport))
      if (!isStruck || isReported(vertiport)) return []
      const spans = routesOf(vertiport, vertiports).map((route) => spanOf(route, inForce))
      if (!spans.every((span) => span !== undefined)) return []
      const since = Math.max(...spans.map((span) => span.since))
      const until = Math.min(...spans.map((span) => span.until))
      return [{ vertiport, since, ...(until === Infinity ? {} : { until }) }]
    },
  )
  const closed = new Set([...found, ...ofVertiports].map((one) => one.vertiport))
  const rest = ofRoutes.filter((one) => !endsOf(one).some((end) => closed.has(end)))
  return [...ofVertiports, ...found, ...rest]
}

function endsOf({ from, to }: RouteRecord): number[] {
  return [from, to]
}

/** The span in which a route is closed by any of the closures. */
function spanOf(
  { from, to }: RouteRecord,
  inForce: readonly ClosureRecord[],
): { since: Seconds; until: Seconds } | undefined {
  const its = inForce.filter((one) =>
    'vertiport' in one ? [from, to].includes(one.vertiport) : one.from === from && one.to === to,
  )
  if (its.length === 0) return undefined
  return {
    since: Math.min(...its.map(({ since }) => since)),
    until: Math.max(...its.map(({ until }) => until ?? Infinity)),
  }
}

function routesOf(vertiport: number, vertiports: number): RouteRecord[] {
  const others = Array.from({ length: vertiports }, (_, at) => at).filter((at) => at !== vertiport)
  return others.flatMap((other) => [
    { from: vertiport, to: other },
    { from: other, to: vertiport },
  ])
}

function recordOf(routes: Routes, { since, until, reason }: Span): ClosureRecord {
  return {
    ...routes,
    since,
    ...(until === undefined ? {} : { until }),
    ...(reason === undefined ? {} : { reason }),
  }
}

/** Identifies the closure of a whole vertiport, as long as its routes have the same end. */
function wholeOf({ whole, since, until }: Span): string | undefined {
  return whole === undefined ? undefined : `${whole.seq} ${whole.vertiport} ${since} ${until ?? ''}`
}

function key({ from, to }: RouteRecord): string {
  return `${from} ${to}`
}

function routeOf(name: string): RouteRecord {
  const [from = 0, to = 0] = name.split(' ').map(Number)
  return { from, to }
}
