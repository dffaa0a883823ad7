// Keys in text form: `a`, `?`, `Enter`, `Mod+k` (Ctrl, or Cmd on a Mac), and sequences such as `g
// n`.

/** The part of a keyboard event that identifies the key. */
export interface Pressed {
  key: string
  ctrlKey: boolean
  metaKey: boolean
  altKey: boolean
}

/** The key of an event; undefined for modifier keys alone. */
export function keyOf({ key, ctrlKey, metaKey, altKey }: Pressed): string | undefined {
  if (['Shift', 'Control', 'Alt', 'Meta', 'AltGraph', 'Dead', 'Process'].includes(key)) return undefined
  const named = key === ' ' ? 'Space' : key
  if (ctrlKey || metaKey) return `Mod+${named.toLowerCase()}`
  return altKey ? `Alt+${named}` : named
}

/**
 * Whether a key types a character. Such commands can be switched off, because voice input or a slip
 * triggers them easily.
 */
export function isCharacter(keys: string): boolean {
  return keys.split(' ').every((key) => key.length === 1)
}

/** Recognises keys that are pressed in sequence within a short time. */
export class Sequence {
  #first: { key: string; at_ms: number } | undefined

  /** The possible meanings of a key: in sequence with the previous key, or alone. */
  press(key: string, at_ms: number, longest_ms = 1200): string[] {
    const first = this.#first
    this.#first = { key, at_ms }
    return first !== undefined && at_ms - first.at_ms <= longest_ms ? [`${first.key} ${key}`, key] : [key]
  }

  forget(): void {
    this.#first = undefined
  }
}
