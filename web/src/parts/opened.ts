// Opening and closing a form or a list over the page, the same for all of them. At opening the
// focus moves to the first control, and the keys of the view stop. At closing the focus goes back.

import type { Attachment } from 'svelte/attachments'
import { untrack } from 'svelte'
import { commands } from '../state/commands.svelte'

const FIELDS = 'input, select, textarea'

/**
 * The control that has the focus first: the one marked `data-first`, the first field of a form, or
 * the first button. A switch outside a form is never the first, because Space would turn it.
 */
export function firstControl(element: HTMLElement): HTMLElement | null {
  const marked = element.querySelector<HTMLElement>('[data-first]')
  const form = element.matches('form') ? element : element.querySelector('form')
  return marked ?? form?.querySelector<HTMLElement>(FIELDS) ?? element.querySelector<HTMLElement>('button')
}

/** Attaches to an element that exists while the form or list is open; Escape calls `close`. */
export function opened(close: () => void): Attachment<HTMLElement> {
  return (element) =>
    untrack(() => {
      const before = document.activeElement
      const uncover = commands.cover(close)
      firstControl(element)?.focus()
      return () => {
        uncover()
        // Keep a focus that the user has moved elsewhere.
        const now = document.activeElement
        if (now !== document.body && !element.contains(now)) return
        if (before instanceof HTMLElement) before.focus()
      }
    })
}
