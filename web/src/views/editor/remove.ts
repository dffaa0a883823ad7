// Removes a vertiport on behalf of the map or the table, with the same message and undo.

import { removeVertiport } from '../../model/network/places'
import { toasts } from '../../state/toasts.svelte'
import { text } from '../../text/text'
import { editor } from './editor.svelte'

/** Removes a vertiport with all references to it, and returns the message. */
export function removeVertiportAt(index: number): string {
  const message = text.editor.map.removed(editor.draft.vertiports[index]?.id ?? '')
  editor.change((file) => removeVertiport(file, index))
  editor.vertiport = undefined
  toasts.done(message, { title: text.editor.undo, run: () => editor.undo() })
  return message
}
