// Errors as the service answers them (RFC 9457): each has a stable code, says what is wrong, and mostly what to do.

import type { components } from './schema'

/** A request that the service refused, or that did not reach it. */
export class ProblemError extends Error {
  override readonly name = 'ProblemError'
  constructor(
    /** The status of HTTP; 0 if no answer came. */
    readonly status: number,
    /** The stable code of the error index, for example `V604`; empty if it was not the service that answered. */
    readonly code: string,
    readonly detail: string,
    readonly hint: string | undefined,
  ) {
    super(detail)
  }
}

/** What was caught, if a request was refused; anything else is an error of our own, and not hidden. */
export function refusal(cause: unknown): ProblemError {
  if (cause instanceof ProblemError) return cause
  throw cause
}

/** No answer came: the service does not run, or the network is away. */
export function noAnswer(cause: unknown): ProblemError {
  return new ProblemError(0, '', cause instanceof Error ? cause.message : String(cause), undefined)
}

/** Reads the problem in an answer. A proxy may have answered instead of the service, with anything. */
export function problemOf(status: number, body: unknown): ProblemError {
  if (isProblem(body)) return new ProblemError(status, body.code, body.detail, body.hint ?? undefined)
  return new ProblemError(
    status,
    '',
    typeof body === 'string' && body !== '' ? body : `HTTP ${status}`,
    undefined,
  )
}

function isProblem(body: unknown): body is components['schemas']['Problem'] {
  return typeof body === 'object' && body !== null && 'code' in body && 'detail' in body
}
