// Days to replay: a scenario and what one or more policies made of it. They come from files, from the service, or from the page
// itself.

import { Earnings } from '../model/earnings'
import type { DayRecord } from '../model/record'
import type { Scenario } from '../model/scenario'
import { fleetCost, FileError, isTrace, parseScenario, recordOf } from '../model/traces'

/** A day as the page of a report holds it. */
export interface ReplayDay {
  name: string
  scenario: Scenario
  plays: Play[]
  /** Whether more of it is yet to come, so that what it was worth is said of so far. */
  isUnfinished?: boolean
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
  record: DayRecord
  profit_usd?: undefined
}

/** A play that has been read. */
export interface Played {
  policy: string
  title: string
  explanation?: string | undefined
  record: DayRecord
  earnings: Earnings
}

export function playedOf({ scenario }: ReplayDay, play: Play): Played {
  const { policy } = play
  const titled =
    'record' in play
      ? { title: play.title, explanation: play.explanation, record: play.record }
      : { title: policy, record: recordOf(scenario, play.trace, policy) }
  return { policy, ...titled, earnings: new Earnings(titled.record, fleetCost(scenario)) }
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

/** Makes a day of files: one scenario and any number of traces, which are called as their files. The error of a file that cannot be
 *  shown has its name. */
export function dayOfFiles(files: readonly NamedText[], former?: ReplayDay): ReplayDay {
  const traces = files.filter(({ text }) => isTrace(text))
  const others = files.filter(({ text }) => !isTrace(text))
  const [first, second] = others
  if (second !== undefined) throw new FileError({ what: 'no-scenario' }, second.name)
  const scenario = first === undefined ? former?.scenario : ofFile(first, () => parseScenario(first.text))
  if (scenario === undefined) throw new FileError({ what: 'no-scenario' })
  const kept = first === undefined ? former : undefined
  const added = traces.map((file): Play => {
    const play = { policy: policyOf(file.name, scenario.name), trace: file.text }
    // Reading it says now what is wrong with the file, and not when it is looked at.
    ofFile(file, () => recordOf(scenario, play.trace))
    return play
  })
  // A file that is given again takes the place of what it was.
  const plays = [...new Map([...(kept?.plays ?? []), ...added].map((one) => [one.policy, one])).values()]
  if (plays.length === 0) throw new FileError({ what: 'no-trace' })
  return { name: scenario.name, scenario, plays, isUnfinished: kept?.isUnfinished ?? false }
}

function ofFile<T>({ name }: NamedText, read: () => T): T {
  try {
    return read()
  } catch (error) {
    throw error instanceof FileError ? new FileError(error.fault, name) : error
  }
}

/** `prices` of `new-york-100-prices.csv`: what the name of a trace adds to that of its day. */
function policyOf(file: string, day: string): string {
  const name = file.replace(/^.*[/\\]/, '').replace(/\.[^.]*$/, '')
  const added = name.startsWith(day) ? name.slice(day.length).replace(/^[-_. ]+/, '') : name
  return added === '' ? name : added
}
