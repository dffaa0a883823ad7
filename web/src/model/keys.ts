// Keys as people write them: `a`, `?`, `Enter`, `Mod+k` (Ctrl, or Cmd on a Mac), and two after each other as `g n`.

/** What of a keyboard event says which key was pressed. */
export interface Pressed {
  key: string
  ctrlKey: boolean
  metaKey: boolean
  altKey: boolean
}

/** The key of an event; undefined for those that only change others. */
export function keyOf({ key, ctrlKey, metaKey, altKey }: Pressed): string | undefined {
  if (['Shift', 'Control', 'Alt', 'Meta', 'AltGraph', 'Dead', 'Process'].includes(key)) return undefined
  const named = key === ' ' ? 'Space' : key
  if (ctrlKey || metaKey) return `Mod+${named.toLowerCase()}`
  return altKey ? `Alt+${named}` : named
}

/** Whether a key types a character: such commands can be switched off, since they are easily hit by accident or by voice. */
export function isCharacter(keys: string): boolean {
  return keys.split(' ').every((key) => key.length === 1)
}

/** Keys that are pressed one after the other within a short time. */
export class Sequence {
  #first: { key: string; at_ms: number } | undefined

  /** What a key may mean: itself after the former one, or itself alone. */
  press(key: string, at_ms: number, longest_ms = 1200): string[] {
    const first = this.#first
    this.#first = { key, at_ms }
    return first !== undefined && at_ms - first.at_ms <= longest_ms ? [`${first.key} ${key}`, key] : [key]
  }

  forget(): void {
    this.#first = undefined
  }
}
