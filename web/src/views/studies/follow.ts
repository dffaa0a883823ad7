// Follows a study until it has ended. It polls, because the service has no stream of studies: they
// last for minutes and have few viewers.

import { NOT_FOUND, ProblemError } from '../../api/problem'
import type { StudyInfo } from '../../api/types'
import { session } from '../../state/session.svelte'

const POLL_MS = 700
/** The interval while the service does not answer. */
const RETRY_MS = 3_000

export function hasEnded({ state }: StudyInfo): boolean {
  return state === 'finished' || state === 'failed'
}

/**
 * Passes on each state of a study until it has ended or is deleted; the returned function stops it.
 */
export function follow(
  study: string,
  onInfo: (info: StudyInfo) => void,
  fail: (problem: ProblemError) => void,
): () => void {
  let isStopped = false
  let timer: ReturnType<typeof setTimeout> | undefined
  const poll = async () => {
    let pause_ms = POLL_MS
    try {
      const info = await session.service.study(study)
      if (isStopped) return
      onInfo(info)
      if (hasEnded(info)) return
    } catch (cause) {
      if (!(cause instanceof ProblemError)) throw cause
      if (isStopped) return
      fail(cause)
      if (cause.status === NOT_FOUND) return
      pause_ms = RETRY_MS
    }
    timer = setTimeout(() => void poll(), pause_ms)
  }
  void poll()
  return () => {
    isStopped = true
    clearTimeout(timer)
  }
}
