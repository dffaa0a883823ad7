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
}

/** What one policy made of a day. */
export interface Play {
  policy: string
  /** The text of the trace. */
  trace: string
  /** The profit of the day, if it is known before the trace is read. */
  profit_usd?: number
}

/** A play that has been read. */
export interface Played {
  policy: string
  record: DayRecord
  earnings: Earnings
}

export function playedOf({ scenario }: ReplayDay, { policy, trace }: Play): Played {
  const record = recordOf(scenario, trace, policy)
  return { policy, record, earnings: new Earnings(record, fleetCost(scenario)) }
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

/** Makes a day of files: one scenario and any number of traces, which are called as their files. */
export function dayOfFiles(files: readonly NamedText[], former?: ReplayDay): ReplayDay {
  const traces = files.filter(({ text }) => isTrace(text))
  const others = files.filter(({ text }) => !isTrace(text))
  const scenario = others[0] === undefined ? former?.scenario : parseScenario(others[0].text)
  if (scenario === undefined || others.length > 1) throw new FileError({ what: 'no-scenario' })
  const kept = others.length === 0 ? (former?.plays ?? []) : []
  const added = traces.map(({ name, text }) => ({ policy: policyOf(name, scenario.name), trace: text }))
  const day = { name: scenario.name, scenario, plays: [...kept, ...added] }
  // Reading them says now what is wrong with a file, and not when it is looked at.
  for (const play of day.plays) playedOf(day, play)
  if (day.plays.length === 0) throw new FileError({ what: 'no-trace' })
  return day
}

/** `prices` of `new-york-100-prices.csv`: what the name of a trace adds to that of its day. */
function policyOf(file: string, day: string): string {
  const name = file.replace(/^.*[/\\]/, '').replace(/\.[^.]*$/, '')
  const added = name.startsWith(day) ? name.slice(day.length).replace(/^[-_. ]+/, '') : name
  return added === '' ? name : added
}
