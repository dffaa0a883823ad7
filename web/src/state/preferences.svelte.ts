// The user's preferences on this machine. The console also works in a browser without storage.

export type Theme = 'system' | 'light' | 'dark'

const KEY = 'vertifleet-preferences'

interface Kept {
  theme?: Theme
  hasSingleKeys?: boolean
}

function kept(): Kept {
  try {
    return JSON.parse(localStorage.getItem(KEY) ?? '{}') as Kept
  } catch {
    return {}
  }
}

class Preferences {
  #theme = $state<Theme>(kept().theme ?? 'system')
  #hasSingleKeys = $state(kept().hasSingleKeys ?? true)
  #prefersDark = $state(false)

  constructor() {
    const dark = matchMedia('(prefers-color-scheme: dark)')
    this.#prefersDark = dark.matches
    dark.addEventListener('change', () => (this.#prefersDark = dark.matches))
    this.#show()
  }

  get theme(): Theme {
    return this.#theme
  }

  set theme(theme: Theme) {
    this.#theme = theme
    this.#keep()
  }

  /** Whether the theme is dark, for pictures that draw their own colours. */
  get isDark(): boolean {
    return this.#theme === 'system' ? this.#prefersDark : this.#theme === 'dark'
  }

  /** Whether keys without Ctrl run commands (WCAG 2.1.4). */
  get hasSingleKeys(): boolean {
    return this.#hasSingleKeys
  }

  set hasSingleKeys(hasSingleKeys: boolean) {
    this.#hasSingleKeys = hasSingleKeys
    this.#keep()
  }

  #keep(): void {
    this.#show()
    const all: Kept = { theme: this.#theme, hasSingleKeys: this.#hasSingleKeys }
    try {
      localStorage.setItem(KEY, JSON.stringify(all))
    } catch {
      // The setting lasts until the page is closed.
    }
  }

  #show(): void {
    document.documentElement.dataset['theme'] = this.#theme
  }
}

export const preferences = new Preferences()
