// Days to replay: a scenario and what one or more policies made of it. They come from files, from the service, or from the page
// itself.

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

/** A day as the page of a report holds it. */
export interface ReplayDay {
  name: string
  scenario: Scenario
  plays: Play[]
  /** How far it has come, if more of it is yet to come: what is compared is compared up to then. */
  until?: Seconds
}

/** What one policy made of a day: a trace as files and reports have it, or a record that was made of something else. */
export type Play = TracedPlay | RecordedPlay

export interface TracedPlay {
  /** What it is called, also in addresses. */
  policy: string
  /** The text of the trace. */
  trace: string
  /** The profit of the day, if it is known before the trace is read. */
  profit_usd?: number
}

export interface RecordedPlay {
  /** What it is called in addresses. */
  policy: string
  /** What it is called in the page, and what that means. */
  title: string
  explanation?: string
  /** Whether it is what a policy planned for the day that was forecast, and nothing that was flown. */
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
  /** Whether it was played on the day of the scenario, as all its traces are: then its decisions can be weighed against those of
   *  another such play. What happened, and what was planned, were days of their own. */
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

/** The plays that are looked at first: the one that is named, or else the best; and beside it the other that is named, or else the
 *  best of the others. An empty name asks for none beside it. */
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

/** What earned most; the first of those whose profits are not known. */
function best(plays: readonly Play[]): Play | undefined {
  const profit = (one: Play) => one.profit_usd ?? -Infinity
  return plays.reduce<Play | undefined>(
    (former, one) => (former !== undefined && profit(former) >= profit(one) ? former : one),
    undefined,
  )
}

/** The days that a page carries; none if it is the page of no report. */
export function embeddedDays(text: string): ReplayDay[] {
  if (text.trim() === '') return []
  return (JSON.parse(text) as { days: ReplayDay[] }).days
}

export interface NamedText {
  name: string
  text: string
}

/** Makes a day of files: one scenario and any number of traces, which are called as their files; or adds traces to a day that is there.
 *  Says of every file that cannot be shown what is wrong with it. */
export function dayOfFiles(files: readonly NamedText[], former?: ReplayDay): ReplayDay {
  const faults: FileError[] = []
  /** What is read of a file; undefined if it is wrong, which is kept. */
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
      // Reading it says now what is wrong with the file, and not when it is looked at.
      const record = attempt(file, () => {
        if (!isTrace(trace)) throw noTrace(trace)
        return scenario && recordOf(scenario, trace)
      })
      if (scenario === undefined || record === undefined) return []
      return [{ policy: policyOf(file.name, scenario.name), trace }]
    })
  // What is missing is said of files that are sound as far as they go.
  if (faults.length > 0) throw new FilesError(faults)
  if (scenario === undefined) throw new FilesError([new FileError({ what: 'scenario-missing' })])
  // A file that is given again takes the place of what it was.
  const plays = [...new Map([...(kept?.plays ?? []), ...added].map((one) => [one.policy, one])).values()]
  if (added.length === 0) throw new FilesError([new FileError({ what: 'trace-missing' })])
  return { ...(kept ?? { name: scenario.name, scenario }), plays }
}

/** `prices` of `new-york-100-prices.csv`: what the name of a trace adds to that of its day. */
function policyOf(file: string, day: string): string {
  const name = file.replace(/^.*[/\\]/, '').replace(/\.[^.]*$/, '')
  const added = name.startsWith(day) ? name.slice(day.length).replace(/^[-_. ]+/, '') : name
  return added === '' ? name : added
}
