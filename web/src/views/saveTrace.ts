// Saves the trace of a day as a file.

import { download } from '../parts/download'
import type { LiveDay } from '../state/liveDay.svelte'
import { session } from '../state/session.svelte'
import { toasts } from '../state/toasts.svelte'

export async function saveTrace({ id, info }: LiveDay): Promise<void> {
  try {
    download(await session.service.trace(id), `${info?.name ?? id}.csv`, 'text/csv')
  } catch (problem) {
    toasts.fail(problem)
  }
}
