// What can be done by key or from the palette. Views add their commands while they are shown.

import { untrack } from 'svelte'
import { isCharacter, keyOf, Sequence } from '../model/keys'
import { preferences } from './preferences.svelte'

export interface Command {
  /** Names the command; of two with the same, the one that was added last holds. */
  id: string
  /** What it does, in the words of a menu. */
  title: string
  /** Under which heading the help lists it. */
  group: string
  /** Keys as `model/keys.ts` writes them; any of them will do. */
  keys?: string[]
  /** Whether the palette lists it only for those who look for its name: there are hundreds like it. */
  isByName?: boolean
  /** Whether it can be done now; a command without is always possible. */
  isPossible?: () => boolean
  run: () => void
}

class Commands {
  #lists = $state.raw<readonly Command[][]>([])
  readonly #sequence = new Sequence()

  /** All commands, those of the view before those of the shell. */
  get all(): Command[] {
    const lastAdded = this.#lists.toReversed().flat()
    const ids = lastAdded.map((command) => command.id)
    return lastAdded.filter((command, index) => ids.indexOf(command.id) === index)
  }

  /** Adds commands until the returned function is called: `$effect(() => commands.add([...]))`. */
  add(list: Command[]): () => void {
    // An effect that adds commands must not run again because others do.
    this.#lists = [...untrack(() => this.#lists), list]
    return () => {
      this.#lists = untrack(() => this.#lists).filter((one) => one !== list)
    }
  }

  /** Does what a key means here. */
  press(event: KeyboardEvent): void {
    const key = keyOf(event)
    if (key === undefined || event.defaultPrevented || event.isComposing || isElsewhere(event, key)) return
    const meanings = this.#sequence.press(key, event.timeStamp)
    const command = this.#meant(meanings)
    if (command === undefined) return
    event.preventDefault()
    this.#sequence.forget()
    command.run()
  }

  #meant(meanings: string[]): Command | undefined {
    for (const meaning of meanings) {
      if (isCharacter(meaning) && !preferences.hasSingleKeys) continue
      const command = this.all.find(
        (one) => one.keys?.includes(meaning) === true && one.isPossible?.() !== false,
      )
      if (command !== undefined) return command
    }
    return undefined
  }
}

export const commands = new Commands()

/** Whether a key belongs to what has the focus: a field that is typed in, a button that is pressed, an open dialog. */
function isElsewhere(event: KeyboardEvent, key: string): boolean {
  if (document.querySelector('dialog[open]') !== null) return true
  const target = event.target
  if (!(target instanceof Element)) return false
  if (key.startsWith('Mod+')) return false
  if (target.closest('input, textarea, select, [contenteditable]') !== null) return true
  return (
    (key === 'Enter' || key === 'Space') &&
    target.closest('button, a, summary, [role=button], [role=option]') !== null
  )
}
