// The texts for refusals by the service. The service also serves programs: its messages are
// lower-case and its hints name requests. Here they become sentences, and a missing object comes
// with a link to the list of such objects.

import { FORBIDDEN, type ProblemError } from '../api/problem'
import { hashOf, type OtherView } from '../model/route'
import { text } from './text'

export interface ProblemText {
  title: string
  hint?: string
  /** The code to look up, if there is one. */
  code?: string
  /** A link to continue from here. */
  way?: { href: string; title: string }
}

const NOT_FOUND_CODE = 'V602'

type Missing = keyof typeof text.errors.notFound
const lists: Readonly<Partial<Record<Missing, OtherView>>> = {
  day: 'days',
  study: 'studies',
  network: 'networks',
}

export function problemText(problem: ProblemError): ProblemText {
  const { status, code, detail, hint, happened } = problem
  if (status === 0) return { title: text.errors.noAnswer }
  // The loser of a race needs to know what came first, not which rule this breaks.
  if (happened !== undefined) return { title: sentenceOf(happened), hint: text.errors.cameFirst, code }
  const missing = code === NOT_FOUND_CODE ? missingOf(detail) : undefined
  if (missing !== undefined) return notFound(missing.what, missing.id)
  const remedy = hint === undefined || isForPrograms(hint) ? undefined : sentenceOf(hint)
  const known = remedy ?? (status === FORBIDDEN ? text.errors.notPermittedHint : undefined)
  return {
    title: sentenceOf(detail),
    ...(known === undefined ? {} : { hint: known }),
    ...(code === '' ? {} : { code }),
  }
}

/** The text for a missing object that an address or a choice names. */
export function notFound(what: Missing, id: string): ProblemText {
  const list = lists[what]
  const { title, hint } = text.errors.notFound[what](id)
  if (list === undefined) return { title, hint }
  const way = { href: hashOf({ view: list, params: {} }), title: text.errors.lists[list] }
  return { title, hint, way }
}

/**
 * Parses `there is no day "zzz"`: the kind of the missing object and its name, if the console has a
 * text for it.
 */
function missingOf(detail: string): { what: Missing; id: string } | undefined {
  const [, what, id] = /^there is no (\w+) "(.*)"$/s.exec(detail) ?? []
  return what !== undefined && id !== undefined && isKnown(what) ? { what, id } : undefined
}

function isKnown(what: string): what is Missing {
  return what in text.errors.notFound
}

/** Whether a hint names a request or one of its headers. */
function isForPrograms(hint: string): boolean {
  return /\b(GET|POST|PUT|DELETE) \/|Idempotency-Key|Authorization:/.test(hint)
}

/**
 * Makes a message a sentence, with a capital, quotation marks and a full stop. A path or a member
 * at the start stays unchanged.
 */
export function sentenceOf(message: string): string {
  const quoted = message.replace(/"([^"\n]*)"/g, '“$1”')
  const begun = /^\p{Ll}+[ ,:]/u.test(quoted) ? quoted.charAt(0).toUpperCase() + quoted.slice(1) : quoted
  return /[.!?…]$/.test(begun) ? begun : `${begun}.`
}
