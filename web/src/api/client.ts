// The console's requests to the service. Every write has an idempotency key, so a write without an
// answer can be sent again without happening twice. Every refusal is thrown as a ProblemError.

import createClient, { type Client } from 'openapi-fetch'
import type { Scenario } from '../model/scenario'
import type { ReplayDay } from '../replay/days'
import { noAnswer, problemOf } from './problem'
import type { paths } from './schema'
import type {
  Comparison,
  DayInfo,
  DayList,
  DayState,
  Event,
  EventList,
  NetworkInfo,
  NewDay,
  NewDecision,
  NewStudy,
  Outlook,
  PeriodDemand,
  PolicyInfo,
  Proposal,
  ServiceInfo,
  StudyInfo,
  Taken,
  TakenDecision,
  TakenEvent,
  WhatIf,
} from './types'

/** Events per request: the maximum that the service allows. */
const PAGE = 1000
/** How long to wait before a request without an answer is sent again. */
const PAUSES_MS = [300, 1000, 2500]

export interface ServiceOptions {
  /** The token of the session, if there is one. */
  token: () => string | undefined
  /** The address of the service; the page's own origin if absent. */
  base?: string
  fetch?: (request: Request) => Promise<Response>
}

/** A client of the service. */
export class Service {
  readonly #client: Client<paths>
  readonly #options: ServiceOptions

  constructor(options: ServiceOptions) {
    this.#options = options
    const send = options.fetch ?? ((request: Request) => fetch(request))
    this.#client = createClient<paths>({
      baseUrl: options.base ?? '',
      fetch: (request) => sendWithRetries(send, request),
    })
    this.#client.use({
      onRequest: ({ request }) => {
        for (const [name, value] of Object.entries(this.headers())) request.headers.set(name, value)
      },
    })
  }

  /** The headers of every request, which carry the token. */
  headers(): Record<string, string> {
    const token = this.#options.token()
    return token === undefined ? {} : { Authorization: `Bearer ${token}` }
  }

  /** The address of a day's event stream. */
  streamUrl(day: string): string {
    return `${this.#options.base ?? ''}/v1/days/${encodeURIComponent(day)}/stream`
  }

  async info(): Promise<ServiceInfo> {
    return answer(await this.#client.GET('/v1'))
  }

  /**
   * All days, the latest first. With `progress`, days that can still change include their progress.
   */
  async days({ progress = false } = {}): Promise<DayInfo[]> {
    const days: DayInfo[] = []
    let after: string | null | undefined
    do {
      const query = { ...(after == null ? {} : { after }), ...(progress ? { progress } : {}) }
      const page: DayList = answer(await this.#client.GET('/v1/days', { params: { query } }))
      days.push(...page.days)
      after = page.next
    } while (after != null)
    return days.reverse()
  }

  async day(day: string): Promise<DayInfo> {
    return answer(await this.#client.GET('/v1/days/{day}', { params: { path: { day } } }))
  }

  async makeDay(body: NewDay): Promise<DayInfo> {
    return answer(await this.#client.POST('/v1/days', { params: { header: freshKey() }, body }))
  }

  async state(day: string, seq?: number): Promise<DayState> {
    const query = seq === undefined ? {} : { seq }
    return answer(await this.#client.GET('/v1/days/{day}/state', { params: { path: { day }, query } }))
  }

  async scenario(day: string): Promise<Scenario> {
    const params = { path: { day } }
    return answer(await this.#client.GET('/v1/days/{day}/scenario', { params })) as unknown as Scenario
  }

  async trace(day: string): Promise<string> {
    const params = { path: { day } }
    return answer(await this.#client.GET('/v1/days/{day}/trace.csv', { params, parseAs: 'text' }))
  }

  /** All events after a sequence number. */
  async events(day: string, after: number): Promise<TakenEvent[]> {
    const events: TakenEvent[] = []
    let next: number | null | undefined = after
    while (next != null) {
      const params = { path: { day }, query: { after: next, limit: PAGE } } as const
      const page: EventList = answer(await this.#client.GET('/v1/days/{day}/events', { params }))
      events.push(...page.events)
      next = page.next
    }
    return events
  }

  async report(day: string, body: Event | Event[], seq?: number): Promise<Taken> {
    const header = { ...freshKey(), ...ifMatch(seq) }
    return answer(
      await this.#client.POST('/v1/days/{day}/events', { params: { path: { day }, header }, body }),
    )
  }

  async propose(day: string, aircraft: string, policy?: string): Promise<Proposal> {
    const query = policy === undefined ? {} : { policy }
    const path = '/v1/days/{day}/aircraft/{aircraft}/decision'
    return answer(await this.#client.GET(path, { params: { path: { day, aircraft }, query } }))
  }

  /** Takes a decision. With `seq` it fails if the day has advanced since that event. */
  async decide(day: string, body: NewDecision, seq?: number): Promise<TakenDecision> {
    const header = { ...freshKey(), ...ifMatch(seq) }
    return answer(
      await this.#client.POST('/v1/days/{day}/decisions', { params: { path: { day }, header }, body }),
    )
  }

  /**
   * How the day is expected to continue. With `seq`, the outlook right after that event; 0 is the
   * morning.
   */
  async outlook(day: string, policy?: string, seq?: number): Promise<Outlook> {
    const query = { ...(policy === undefined ? {} : { policy }), ...(seq === undefined ? {} : { seq }) }
    return answer(await this.#client.GET('/v1/days/{day}/outlook', { params: { path: { day }, query } }))
  }

  /** The passengers who wait in the current period. */
  async demand(day: string): Promise<PeriodDemand> {
    return answer(await this.#client.GET('/v1/days/{day}/demand', { params: { path: { day } } }))
  }

  async whatIf(day: string, body: WhatIf): Promise<Comparison> {
    return answer(await this.#client.POST('/v1/days/{day}/what-if', { params: { path: { day } }, body }))
  }

  async networks(): Promise<NetworkInfo[]> {
    return answer(await this.#client.GET('/v1/networks')).networks
  }

  async network(network: string): Promise<NetworkInfo> {
    return answer(await this.#client.GET('/v1/networks/{network}', { params: { path: { network } } }))
  }

  async validateNetwork(toml: string): Promise<NetworkInfo> {
    return answer(await this.#client.POST('/v1/networks/validate', { body: { toml } }))
  }

  async keepNetwork(network: string, toml: string): Promise<NetworkInfo> {
    return answer(
      await this.#client.PUT('/v1/networks/{network}', { params: { path: { network } }, body: { toml } }),
    )
  }

  async forgetNetwork(network: string): Promise<void> {
    answer(await this.#client.DELETE('/v1/networks/{network}', { params: { path: { network } } }))
  }

  /** All studies, the latest first, without their results. */
  async studies(): Promise<StudyInfo[]> {
    return answer(await this.#client.GET('/v1/studies')).studies
  }

  async study(study: string): Promise<StudyInfo> {
    return answer(await this.#client.GET('/v1/studies/{study}', { params: { path: { study } } }))
  }

  async makeStudy(body: NewStudy): Promise<StudyInfo> {
    return answer(await this.#client.POST('/v1/studies', { params: { header: freshKey() }, body }))
  }

  /** The report page of a study. */
  async studyReport(study: string): Promise<string> {
    const params = { path: { study } }
    return answer(await this.#client.GET('/v1/studies/{study}/report', { params, parseAs: 'text' }))
  }

  /** The first days of a study as each policy played them. */
  async studyReplay(study: string): Promise<ReplayDay[]> {
    const params = { path: { study } }
    const { days } = answer(await this.#client.GET('/v1/studies/{study}/replay', { params }))
    return days as unknown as ReplayDay[]
  }

  /** Stops a study if it is running or waiting, and deletes it. */
  async endStudy(study: string): Promise<void> {
    answer(await this.#client.DELETE('/v1/studies/{study}', { params: { path: { study } } }))
  }

  async policies(): Promise<PolicyInfo[]> {
    return answer(await this.#client.GET('/v1/policies')).policies
  }
}

/** A unique key, drawn at random as the service recommends. */
function freshKey(): { 'Idempotency-Key': string } {
  return { 'Idempotency-Key': `console-${crypto.randomUUID()}` }
}

function ifMatch(seq: number | undefined): { 'If-Match'?: string } {
  return seq === undefined ? {} : { 'If-Match': `"${seq}"` }
}

/** Returns the answer of the service, or throws its refusal as an error. */
function answer<T>(result: { data?: T; error?: unknown; response: Response }): T {
  if (!result.response.ok) throw problemOf(result.response.status, result.error)
  return result.data as T
}

/**
 * Sends a request again if there is no answer and a repetition is safe: it only reads, or it has a
 * key.
 */
async function sendWithRetries(
  send: (request: Request) => Promise<Response>,
  request: Request,
): Promise<Response> {
  const isSafe = request.method === 'GET' || request.headers.has('Idempotency-Key')
  const pauses = isSafe ? PAUSES_MS : []
  for (const pause_ms of pauses) {
    try {
      const response = await send(request.clone())
      if (response.status !== 503 && response.status !== 502) return response
    } catch (cause) {
      if (request.signal.aborted) throw noAnswer(cause)
    }
    await new Promise((resume) => setTimeout(resume, pause_ms))
  }
  try {
    return await send(request)
  } catch (cause) {
    throw noAnswer(cause)
  }
}
