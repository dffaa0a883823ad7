// Follows a study until it has ended. The service has no stream of studies: they last for minutes, and few people look.

import { ProblemError } from '../../api/problem'
import type { StudyInfo } from '../../api/types'
import { session } from '../../state/session.svelte'

const LOOK_MS = 700
/** While the service does not answer. */
const PATIENCE_MS = 3_000

export function hasEnded({ state }: StudyInfo): boolean {
  return state === 'finished' || state === 'failed'
}

/** Tells what a study says until it has ended or is gone; the returned function stops that. */
export function follow(
  study: string,
  tell: (info: StudyInfo) => void,
  fail: (problem: ProblemError) => void,
): () => void {
  let isStopped = false
  let timer: ReturnType<typeof setTimeout> | undefined
  const look = async () => {
    let pause_ms = LOOK_MS
    try {
      const info = await session.service.study(study)
      if (isStopped) return
      tell(info)
      if (hasEnded(info)) return
    } catch (cause) {
      if (!(cause instanceof ProblemError)) throw cause
      if (isStopped) return
      fail(cause)
      if (cause.status === 404) return
      pause_ms = PATIENCE_MS
    }
    timer = setTimeout(() => void look(), pause_ms)
  }
  void look()
  return () => {
    isStopped = true
    clearTimeout(timer)
  }
}
