// The service's findings about a network, with their positions in the file. A message of the
// service names the member. Its path leads to the field of a form and to a line of the text.

import { readableFinding } from '../../text/findings'
import { draftOf } from './draft'
import { beginsWith, type Path, type Step, type TomlFile } from './toml'

export interface Finding {
  kind: 'error' | 'warning'
  /** The code of the error index; empty for a warning and for invalid TOML. */
  code: string
  message: string
  hint: string | undefined
  /** The member that it is about; empty if it is about the whole file. */
  path: Path
  /** The line of the text, from 1; undefined if it is about the whole file. */
  line: number | undefined
}

/** Why the service refused a network. */
export interface Refusal {
  code: string
  detail: string
  hint: string | undefined
}

const ORIGIN = 'the network: '
const NAMED = /^(vertiport|aircraft type) "(.*)"$/
const MEMBER = /^[a-z_]+(?:\[\d+\])*$/
/** The member at the start of the last part, before the rule that it violates. */
const BROKEN = /^([a-z_]+(?:\[\d+\])*) (?:must|names|has)\b/
const ENTRY_BROKEN = /^(vertiport|aircraft type) "([^"]*)" must\b/
/** The position in an error message of the TOML reader. */
const AT_LINE = /^line (\d+), column (\d+): (?:([a-z_0-9.[\]]+): )?(.*)$/s

export function findingOf({ code, detail, hint }: Refusal, file: TomlFile): Finding {
  const message = detail.startsWith(ORIGIN) ? detail.slice(ORIGIN.length) : detail
  const line = AT_LINE.exec(message)
  if (line !== null) {
    const [, number, , dotted, rule = message] = line
    const path = dotted === undefined ? [] : stepsOf(dotted.replaceAll('.', ': '))
    return {
      kind: 'error',
      code,
      message: dotted ? `${dotted}: ${rule}` : rule,
      hint,
      path,
      line: Number(number),
    }
  }
  const path = message.includes('time zone') ? ['time_zone'] : pathOf(message, file)
  return { kind: 'error', code, message: readableFinding(message), hint, path, line: lineOf(file, path) }
}

export function findingOfWarning(message: string, file: TomlFile): Finding {
  const id = /vertiport "([^"]*)"/.exec(message)?.[1]
  const path = id === undefined ? [] : entry(file, 'vertiport', id)
  return { kind: 'warning', code: '', message, hint: undefined, path, line: lineOf(file, path) }
}

/** The finding about a member or about something within it. */
export function findingAt(findings: readonly Finding[], path: Path): Finding | undefined {
  return findings.find((finding) => finding.path.length > 0 && beginsWith(finding.path, path))
}

function lineOf(file: TomlFile, path: Path): number | undefined {
  const span = file.span(path)
  return span === undefined ? undefined : file.line(span.from)
}

/** Parses messages such as `daily_demand: gravity: weights[2] must be at least 0`. */
function pathOf(message: string, file: TomlFile): Path {
  const parts = message.split(': ')
  const path: Step[] = []
  for (const part of parts) {
    const named = NAMED.exec(part) ?? ENTRY_BROKEN.exec(part)
    if (named?.[1] !== undefined && named[2] !== undefined) path.push(...entry(file, named[1], named[2]))
    else if (MEMBER.test(part)) path.push(...stepsOf(part))
    else {
      const broken = BROKEN.exec(part)?.[1]
      if (broken !== undefined) path.push(...stepsOf(broken))
      break
    }
  }
  if (path.length === 0 && message.startsWith('the fleet')) return ['fleet']
  return withinDemand(path, file)
}

/** Messages about periods do not name the table that contains them. */
function withinDemand(path: Path, file: TomlFile): Path {
  if (path[0] !== 'periods') return path
  const tables = ['daily_demand', 'hourly_demand', 'demand', 'uniform_demand']
  const table = tables.find((one) => file.find([one, 'periods']) !== undefined)
  return table === undefined ? path : [table, ...path]
}

function entry(file: TomlFile, kind: string, id: string): Path {
  const { vertiports, types } = draftOf(file.value)
  const [list, entries] =
    kind === 'vertiport' ? (['vertiports', vertiports] as const) : (['aircraft_types', types] as const)
  const index = entries.findIndex((one) => one.id === id)
  return index < 0 ? [list] : [list, index]
}

/** `a: b[2]` as `['a', 'b', 2]`. */
function stepsOf(text: string): Step[] {
  return (text.match(/[a-z_]+|\d+(?=\])/g) ?? []).map((step) => (/^\d/.test(step) ? Number(step) : step))
}
