// What the console says about what was done: shown for a while, errors until they are closed.

import { refusal } from '../api/problem'
import { said } from '../text/problems'
import { text } from '../text/text'

export interface Toast {
  id: number
  kind: 'done' | 'error'
  title: string
  detail?: string
  hint?: string
  code?: string
  /** What takes it back, for a while and as long as that is possible. */
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

  /** Says what a request failed of, with its code and remedy. Anything else is an error of our own, and not hidden. */
  fail(problem: unknown): void {
    const refused = refusal(problem)
    const { title, hint, code } = said(refused)
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
    // Of what was done only the latest is said, and no error is said twice: what is worked with stays in view.
    const others = this.list.filter((one) => one.kind === 'error' && one.title !== toast.title)
    this.list = [...others, { ...toast, id }].slice(-MOST)
    return id
  }
}

export const toasts = new Toasts()
