// Days to replay: a scenario and its plays by one or more policies. They come from files, from the
// service, or from the page itself.

import { Earnings } from '../model/earnings'
import type { DayRecord, Seconds } from '../model/record'
import type { Scenario } from '../model/scenario'
import {
  fixedCost,
  FileError,
  FilesError,
  isJson,
  isTrace,
  noTrace,
  parseScenario,
  recordOf,
} from '../model/traces'

/** A day as stored in a report's page. */
export interface ReplayDay {
  name: string
  scenario: Scenario
  plays: Play[]
  /** The current time of a day that is not over; comparisons extend up to it. */
  until?: Seconds
}

/**
 * One policy's play of a day: a trace, as in files and reports, or a record from another source.
 */
export type Play = TracedPlay | RecordedPlay

export interface TracedPlay {
  /** Its name, also in addresses. */
  policy: string
  /** The text of the trace. */
  trace: string
  /** The profit of the day, if it is known before the trace is read. */
  profit_usd?: number
}

export interface RecordedPlay {
  /** Its name in addresses. */
  policy: string
  /** Its name in the page, and an explanation of it. */
  title: string
  explanation?: string
  /** Whether it is a policy's plan for the forecast day rather than a flown day. */
  isPlan?: boolean
  record: DayRecord
  profit_usd?: undefined
}

/** A play that has been read. */
export interface Played {
  policy: string
  title: string
  explanation?: string | undefined
  isPlan: boolean
  /**
   * Whether it was played on the scenario's day, as all its traces are. Its decisions can then be
   * compared with those of another such play. The actual day and a plan are different days.
   */
  isOfScenario: boolean
  record: DayRecord
  earnings: Earnings
}

export function playedOf({ scenario }: ReplayDay, play: Play): Played {
  const { policy } = play
  const titled =
    'record' in play
      ? { title: play.title, explanation: play.explanation, record: play.record }
      : { title: policy, record: recordOf(scenario, play.trace, policy) }
  const kind = { isPlan: 'record' in play && play.isPlan === true, isOfScenario: 'trace' in play }
  return { policy, ...titled, ...kind, earnings: new Earnings(titled.record, fixedCost(scenario)) }
}

/**
 * The plays to show first: the named one, otherwise the best; and next to it the other named one,
 * otherwise the best of the rest. An empty name means no second play.
 */
export function chosenPlays(
  plays: readonly Play[],
  policy: string | undefined,
  other: string | undefined,
): { play: Play | undefined; other: Play | undefined } {
  const play = plays.find((one) => one.policy === policy) ?? best(plays)
  const others = plays.filter((one) => one !== play)
  const isAlone = other === ''
  return { play, other: isAlone ? undefined : (others.find((one) => one.policy === other) ?? best(others)) }
}

/** The play with the highest profit; the first one if profits are unknown. */
function best(plays: readonly Play[]): Play | undefined {
  const profit = (one: Play) => one.profit_usd ?? -Infinity
  return plays.reduce<Play | undefined>(
    (former, one) => (former !== undefined && profit(former) >= profit(one) ? former : one),
    undefined,
  )
}

/** The days in a page; none if the page is not part of a report. */
export function embeddedDays(text: string): ReplayDay[] {
  if (text.trim() === '') return []
  return (JSON.parse(text) as { days: ReplayDay[] }).days
}

export interface NamedText {
  name: string
  text: string
}

/**
 * Makes a day from files: one scenario and any number of traces, named after their files.
 * Alternatively adds traces to an existing day. Reports the fault of every file that cannot be
 * shown.
 */
export function dayOfFiles(files: readonly NamedText[], former?: ReplayDay): ReplayDay {
  const faults: FileError[] = []
  /** Reads a file; undefined if it is faulty, in which case the fault is collected. */
  const attempt = <T>({ name }: NamedText, read: () => T): T | undefined => {
    try {
      return read()
    } catch (error) {
      if (!(error instanceof FileError)) throw error
      faults.push(new FileError(error.fault, name))
      return undefined
    }
  }
  const scenarios = files.filter(({ text }) => isJson(text))
  const found = scenarios.flatMap((file) => {
    const scenario = attempt(file, () => parseScenario(file.text))
    return scenario === undefined ? [] : [{ file, scenario }]
  })
  const [first, ...more] = found
  for (const { file } of more)
    faults.push(new FileError({ what: 'second-scenario', first: first?.file.name ?? '' }, file.name))
  const kept = scenarios.length === 0 ? former : undefined
  const scenario = first?.scenario ?? kept?.scenario
  const added = files
    .filter((file) => !scenarios.includes(file))
    .flatMap((file): Play[] => {
      const trace = file.text
      // Reading the trace now reports a fault immediately rather than when it is shown.
      const record = attempt(file, () => {
        if (!isTrace(trace)) throw noTrace(trace)
        return scenario && recordOf(scenario, trace)
      })
      if (scenario === undefined || record === undefined) return []
      return [{ policy: policyOf(file.name, scenario.name), trace }]
    })
  // Missing files are reported only if the others are valid.
  if (faults.length > 0) throw new FilesError(faults)
  if (scenario === undefined) throw new FilesError([new FileError({ what: 'scenario-missing' })])
  // A file with the name of an earlier one replaces it.
  const plays = [...new Map([...(kept?.plays ?? []), ...added].map((one) => [one.policy, one])).values()]
  if (added.length === 0) throw new FilesError([new FileError({ what: 'trace-missing' })])
  return { ...(kept ?? { name: scenario.name, scenario }), plays }
}

/** `prices` for `new-york-100-prices.csv`: the part of a trace's name after the name of its day. */
function policyOf(file: string, day: string): string {
  const name = file.replace(/^.*[/\\]/, '').replace(/\.[^.]*$/, '')
  const added = name.startsWith(day) ? name.slice(day.length).replace(/^[-_. ]+/, '') : name
  return added === '' ? name : added
}
