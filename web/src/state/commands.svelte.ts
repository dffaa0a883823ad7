// The commands of the keyboard and the palette. Views add their commands while they are shown.

import { untrack } from 'svelte'
import { isCharacter, keyOf, Sequence } from '../model/keys'
import { preferences } from './preferences.svelte'

export interface Command {
  /** Identifies the command; if two have the same id, the one added last applies. */
  id: string
  /** The label in menus. */
  title: string
  /** The heading under which the help lists it. */
  group: string
  /** Keys in the format of `model/keys.ts`; any of them triggers the command. */
  keys?: string[]
  /**
   * Whether the palette lists it only when the search matches its name, because there are hundreds
   * like it.
   */
  isByName?: boolean
  /** Whether it is currently possible; a command without this is always possible. */
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
    // An effect that adds commands must not run again when others are added.
    this.#lists = [...untrack(() => this.#lists), list]
    return () => {
      this.#lists = untrack(() => this.#lists).filter((one) => one !== list)
    }
  }

  /** Runs the command of a key, if there is one. */
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

/** Whether the focused element handles the key: a field, a button, or an open dialog. */
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
