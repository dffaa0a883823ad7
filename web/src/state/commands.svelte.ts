// The commands of the keyboard and the palette. Views add their commands while they are shown. An
// open form or list covers the view: until it is closed, only commands of the whole console are
// possible, so no key acts on what is covered.

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
  /** Whether it belongs to the whole console, so that an open form or list does not exclude it. */
  isEverywhere?: boolean
  run: () => void
}

/** An open form or list, which covers the view. */
interface Cover {
  close: () => void
}

/** What effects have added and not removed yet, the latest last. */
class Added<T> {
  all = $state.raw<readonly T[]>([])
  // The same without reactivity, for changes. The end of an effect reads states as they were before
  // the changes of the same moment, so it would lose what another effect has just added.
  #latest = this.all

  /** Adds one until the returned function is called. */
  add(added: T): () => void {
    this.all = this.#latest = [...this.#latest, added]
    return () => {
      this.all = this.#latest = this.#latest.filter((one) => one !== added)
    }
  }
}

class Commands {
  readonly #lists = new Added<Command[]>()
  /** The open forms and lists. */
  readonly #covers = new Added<Cover>()
  readonly #sequence = new Sequence()

  /** All commands, those of the view before those of the shell. */
  get all(): Command[] {
    const lastAdded = this.#lists.all.toReversed().flat()
    const ids = lastAdded.map((command) => command.id)
    return lastAdded.filter((command, index) => ids.indexOf(command.id) === index)
  }

  /** Adds commands until the returned function is called: `$effect(() => commands.add([...]))`. */
  add(list: Command[]): () => void {
    return this.#lists.add(list)
  }

  /** Covers the view with an open form or list, until the returned function is called. */
  cover(close: () => void): () => void {
    return this.#covers.add({ close })
  }

  /** Whether a form or a list is open. */
  get isCovered(): boolean {
    return this.#covers.all.length > 0
  }

  /** Whether a command can run now. */
  isPossible({ isEverywhere, isPossible }: Command): boolean {
    return (isEverywhere === true || !this.isCovered) && isPossible?.() !== false
  }

  /** Runs a command, unless it has become impossible. */
  run(command: Command): void {
    if (this.isPossible(command)) command.run()
  }

  /**
   * Runs the command of a key, if there is one. Escape closes the form or list that was opened
   * last. A key that is held down runs its command once.
   */
  press(event: KeyboardEvent): void {
    const key = keyOf(event)
    if (key === undefined || event.defaultPrevented || event.isComposing || event.repeat) return
    if (document.querySelector('dialog[open]') !== null) {
      // The browser would undo the latest input in a field under the dialog.
      if (UNDO.includes(key) && !isField(event.target)) event.preventDefault()
      return
    }
    const cover = this.#covers.all.at(-1)
    if (key === 'Escape' && cover !== undefined) {
      event.preventDefault()
      cover.close()
      return
    }
    if (isElsewhere(event, key)) return
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
      const command = this.all.find((one) => one.keys?.includes(meaning) === true && this.isPossible(one))
      if (command !== undefined) return command
    }
    return undefined
  }
}

export const commands = new Commands()

const UNDO = ['Mod+z', 'Mod+y']

function isField(target: EventTarget | null): boolean {
  return target instanceof Element && target.closest('input, textarea, select, [contenteditable]') !== null
}

/** Whether the focused element handles the key: a field or a button. */
function isElsewhere(event: KeyboardEvent, key: string): boolean {
  const target = event.target
  if (!(target instanceof Element)) return false
  if (key.startsWith('Mod+')) return false
  if (isField(target)) return true
  return (
    (key === 'Enter' || key === 'Space') &&
    target.closest('button, a, summary, [role=button], [role=option]') !== null
  )
}
