// Follows the events of a day: server-sent events over fetch, because an EventSource cannot send a
// token in a header. After a lost connection it resumes where it stopped, so it neither misses nor
// repeats an event.

import { noAnswer, problemOf, type ProblemError } from './problem'
import type { TakenEvent } from './types'

/**
 * The state of the stream: `healing` while it reconnects, `lost` if that has failed for a while or
 * cannot succeed.
 */
export type Connection = 'connecting' | 'connected' | 'healing' | 'lost'

/**
 * The service sends a heartbeat every 2 s; a connection that is silent for longer than this is
 * dead.
 */
const SILENCE_MS = 15_000
/** After this time without a connection the user is informed. The stream keeps trying. */
const LOST_AFTER_MS = 10_000
const FIRST_PAUSE_MS = 250
const LONGEST_PAUSE_MS = 5_000

/**
 * The log of the day differs from the one that the client read: the day was restored from a copy.
 */
const OTHER_LOG = 'V631'

export interface StreamOptions {
  url: string
  headers: () => Record<string, string>
  /** The id of the last event that was read; undefined before the first. */
  after: string | undefined
  onEvents: (events: TakenEvent[]) => void
  onConnection: (connection: Connection, problem?: ProblemError) => void
  /** The service has sent something, at least a heartbeat. */
  onSign?: () => void
  /** The log of the day differs from the one that was read, so everything has to be read again. */
  onRewound: () => void
  fetch?: typeof fetch
  pause?: (ms: number) => Promise<void>
  now?: () => number
}

/** Follows a day until the returned function is called. */
export function follow(options: StreamOptions): () => void {
  const stop = new AbortController()
  void keepFollowing(options, stop.signal)
  return () => stop.abort()
}

async function keepFollowing(options: StreamOptions, stop: AbortSignal): Promise<void> {
  const now = options.now ?? (() => performance.now())
  const pause = options.pause ?? ((ms: number) => new Promise<void>((resume) => setTimeout(resume, ms)))
  let after = options.after
  let attempts = 0
  let lostAt = now()
  options.onConnection('connecting')
  while (!stop.aborted) {
    const ended = await followOnce(options, after, stop, (events) => {
      attempts = 0
      after = events.at(-1)?.mark ?? after
      lostAt = now()
      options.onEvents(events)
    })
    // eslint-disable-next-line @typescript-eslint/no-unnecessary-condition -- set meanwhile.
    if (stop.aborted) return
    if (ended.wasConnected) {
      attempts = 0
      lostAt = now()
    }
    if (ended.problem?.code === OTHER_LOG) {
      options.onRewound()
      return
    }
    if (ended.problem !== undefined && isFinal(ended.problem)) {
      options.onConnection('lost', ended.problem)
      return
    }
    options.onConnection(now() - lostAt > LOST_AFTER_MS ? 'lost' : 'healing', ended.problem)
    await pause(Math.min(LONGEST_PAUSE_MS, FIRST_PAUSE_MS * 2 ** attempts))
    attempts += 1
  }
}

/** Whether another request cannot help, because the service refused the user or the resource. */
function isFinal(problem: ProblemError): boolean {
  return problem.status >= 400 && problem.status < 500 && problem.status !== 408 && problem.status !== 429
}

/** One connection, from its beginning to its end for any reason. */
async function followOnce(
  options: StreamOptions,
  after: string | undefined,
  stop: AbortSignal,
  onEvents: (events: TakenEvent[]) => void,
): Promise<{ wasConnected: boolean; problem?: ProblemError }> {
  const silence = new Silence(stop)
  let wasConnected = false
  try {
    const headers = { ...options.headers(), Accept: 'text/event-stream', 'Last-Event-ID': after ?? '0' }
    const response = await (options.fetch ?? fetch)(options.url, {
      headers,
      signal: silence.signal,
      cache: 'no-store',
    })
    if (!response.ok) return { wasConnected, problem: problemOf(response.status, await bodyOf(response)) }
    if (response.body === null) return { wasConnected }
    wasConnected = true
    options.onConnection('connected')
    const reader = new MessageReader()
    const chunks = response.body.getReader()
    for (;;) {
      const { done, value } = await chunks.read()
      if (done) return { wasConnected }
      silence.isBroken()
      options.onSign?.()
      const events = reader
        .push(value)
        .filter(isEvent)
        .map((message) => JSON.parse(message.data) as TakenEvent)
      if (events.length > 0) onEvents(events)
    }
  } catch (cause) {
    return { wasConnected, problem: noAnswer(cause) }
  } finally {
    silence.end()
  }
}

/** Messages of other types, such as `behind`, add nothing to the events. */
function isEvent(message: Message): boolean {
  return message.type === 'message'
}

async function bodyOf(response: Response): Promise<unknown> {
  const text = await response.text()
  try {
    return JSON.parse(text) as unknown
  } catch {
    return text
  }
}

/** Aborts a connection that has been silent for too long, or that is no longer needed. */
class Silence {
  readonly #ending = new AbortController()
  readonly #stop: AbortSignal
  #timer: ReturnType<typeof setTimeout> | undefined

  constructor(stop: AbortSignal) {
    this.#stop = stop
    stop.addEventListener('abort', this.#abort)
    this.isBroken()
  }

  get signal(): AbortSignal {
    return this.#ending.signal
  }

  isBroken(): void {
    clearTimeout(this.#timer)
    this.#timer = setTimeout(this.#abort, SILENCE_MS)
  }

  end(): void {
    clearTimeout(this.#timer)
    this.#stop.removeEventListener('abort', this.#abort)
    this.#abort()
  }

  readonly #abort = () => this.#ending.abort()
}

/** A message of the stream. */
export interface Message {
  type: string
  data: string
  id: string | undefined
}

/**
 * Reads messages from bytes that may be split anywhere, even inside a line or a character (WHATWG
 * HTML, 9.2.6).
 */
export class MessageReader {
  readonly #decoder = new TextDecoder()
  #rest = ''
  #data: string[] = []
  #type = ''
  #id: string | undefined

  push(bytes: Uint8Array): Message[] {
    this.#rest += this.#decoder.decode(bytes, { stream: true })
    const lines = this.#rest.split(/\r\n|\n|\r(?!$)/)
    this.#rest = lines.pop() ?? ''
    return lines.map((line) => this.#take(line)).filter((message) => message !== undefined)
  }

  #take(line: string): Message | undefined {
    if (line === '') return this.#dispatch()
    const colon = line.indexOf(':')
    if (colon === 0) return undefined
    const field = colon < 0 ? line : line.slice(0, colon)
    const value = colon < 0 ? '' : line.slice(colon + 1).replace(/^ /, '')
    if (field === 'data') this.#data.push(value)
    else if (field === 'event') this.#type = value
    else if (field === 'id') this.#id = value
    return undefined
  }

  #dispatch(): Message | undefined {
    const [data, type] = [this.#data, this.#type]
    this.#data = []
    this.#type = ''
    if (data.length === 0) return undefined
    return { type: type === '' ? 'message' : type, data: data.join('\n'), id: this.#id }
  }
}
