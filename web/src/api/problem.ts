// Errors in the service's format (RFC 9457): each has a stable code, a description and usually a
// remedy.

import type { components } from './schema'

export const UNAUTHORIZED = 401
export const FORBIDDEN = 403
export const NOT_FOUND = 404
/** The day has advanced since the event of the request. */
export const PRECONDITION_FAILED = 412

/** A request that the service refused, or that did not reach it. */
export class ProblemError extends Error {
  override readonly name = 'ProblemError'
  constructor(
    /** The HTTP status; 0 if there was no answer. */
    readonly status: number,
    /**
     * The stable code from the error index, for example `V604`; empty if the answer did not come
     * from the service.
     */
    readonly code: string,
    readonly detail: string,
    readonly hint: string | undefined,
    /** The report or decision of another user that came first, in words. */
    readonly happened?: string,
  ) {
    super(detail)
  }
}

/** Returns the caught refusal. Any other error is a bug and is thrown again. */
export function refusal(cause: unknown): ProblemError {
  if (cause instanceof ProblemError) return cause
  throw cause
}

/** There was no answer: the service is not running, or the network is down. */
export function noAnswer(cause: unknown): ProblemError {
  return new ProblemError(0, '', cause instanceof Error ? cause.message : String(cause), undefined)
}

/**
 * Reads the problem in an answer. A proxy may have answered instead of the service, so the body can
 * be anything.
 */
export function problemOf(status: number, body: unknown): ProblemError {
  if (isProblem(body)) {
    const { code, detail, hint, happened } = body
    return new ProblemError(status, code, detail, hint ?? undefined, happened?.text)
  }
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
