// Vertiports are removed from the map and from the table, with the same words and the same way back.

import { removeVertiport } from '../../model/network/places'
import { toasts } from '../../state/toasts.svelte'
import { text } from '../../text/text'
import { editor } from './editor.svelte'

/** Removes a vertiport with all that refers to it, and gives what was said about it. */
export function removeVertiportAt(index: number): string {
  const said = text.editor.map.removed(editor.draft.vertiports[index]?.id ?? '')
  editor.change((file) => removeVertiport(file, index))
  editor.vertiport = undefined
  toasts.done(said, { title: text.editor.undo, run: () => editor.undo() })
  return said
}
