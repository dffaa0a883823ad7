// Short messages about the user's actions. Most disappear after a while; errors stay until they are
// closed.

import { refusal } from '../api/problem'
import { problemText } from '../text/problems'
import { text } from '../text/text'

export interface Toast {
  id: number
  kind: 'done' | 'error'
  title: string
  detail?: string
  hint?: string
  code?: string
  /** Undoes the action, for a while and only while that is possible. */
  action?: { title: string; run: () => void; isPossible?: () => boolean }
}

const SHOWN_MS = 6_000
const MOST = 4

class Toasts {
  list = $state.raw<readonly Toast[]>([])
  #next = 1

  done(title: string, action?: Toast['action']): void {
    const id = this.#add({ kind: 'done', title, ...(action === undefined ? {} : { action }) })
    setTimeout(() => this.close(id), SHOWN_MS)
  }

  /**
   * Shows a failed request with its code and remedy. Any other error is a bug and is thrown again.
   */
  fail(problem: unknown): void {
    const refused = refusal(problem)
    const { title, hint, code } = problemText(refused)
    const remedy = refused.status === 0 ? text.errors.noAnswerHint : hint
    this.#add({
      kind: 'error',
      title,
      ...(remedy === undefined ? {} : { hint: remedy }),
      ...(code === undefined ? {} : { code }),
    })
  }

  close(id: number): void {
    this.list = this.list.filter((toast) => toast.id !== id)
  }

  #add(toast: Omit<Toast, 'id'>): number {
    const id = this.#next++
    // Only the latest success is shown, and no error twice, so that messages cover little of the
    // page.
    const others = this.list.filter((one) => one.kind === 'error' && one.title !== toast.title)
    this.list = [...others, { ...toast, id }].slice(-MOST)
    return id
  }
}

export const toasts = new Toasts()
