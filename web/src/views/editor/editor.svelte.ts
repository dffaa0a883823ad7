// The edited network: its text, and the service's findings. It outlives the view, so the user can
// look at a day meanwhile, and the tab stores it until it is closed.

import { ProblemError } from '../../api/problem'
import type { NetworkInfo } from '../../api/types'
import { draftOf, member, type Draft } from '../../model/network/draft'
import { apply, remove, set, type Splice } from '../../model/network/edits'
import { findingAt, findingOf, findingOfWarning, type Finding } from '../../model/network/findings'
import { History } from '../../model/network/history'
import type { Literal } from '../../model/network/literals'
import { TomlError, TomlFile, type Path } from '../../model/network/toml'
import { session } from '../../state/session.svelte'
import { toasts } from '../../state/toasts.svelte'

/** The pause in typing after which the service checks the text. */
const PAUSE_MS = 350
const KEY = 'vertifleet-network'
/** Larger texts are not stored in the tab. */
const MOST_KEPT = 1_000_000

export type Tab = 'places' | 'fleet' | 'tariffs' | 'demand' | 'days' | 'text'

/** The tab of the forms for a member, by the first step of its path. */
const tabOf: Readonly<Record<string, Tab>> = {
  vertiports: 'places',
  aircraft_types: 'fleet',
  fleet: 'fleet',
  start_charge: 'fleet',
  tariffs: 'tariffs',
  demand: 'demand',
  daily_demand: 'demand',
  hourly_demand: 'demand',
  uniform_demand: 'demand',
}

/** A network to edit. */
export interface Opened {
  toml: string
  /** Its name in the service; empty if it is not stored there. */
  source: string
  /** Whether it was saved in the service by users, rather than shipped with the program. */
  isOwn: boolean
}

/** A network by its text. */
export interface NetworkText {
  name: string
  toml: string
}

interface Kept {
  text: string
  saved: string
  source: string
  isOwn: boolean
  origin?: NetworkText | undefined
}

class Editor {
  #history = $state.raw<History>()
  /** The text as last read or saved. */
  #saved = $state('')
  #first = $state('')
  /** The network of the service that it was read from or saved as; empty if there is none. */
  source = $state('')
  isOwn = $state(false)
  /**
   * The saved network it was made from, with which its changes are compared; a new one has none
   * until it is saved.
   */
  origin = $state.raw<NetworkText>()
  tab = $state<Tab>('places')
  /** Whether the text is next to the forms, or in a separate tab if there is no room. */
  showsText = $state(true)
  isNarrow = $state(false)
  /** Counts the opened networks, so that pictures can reset. */
  opened = $state(0)
  /** The selected vertiport, on the map and in its form. */
  vertiport = $state<number>()
  info = $state.raw<NetworkInfo>()
  #checked = $state.raw<Finding[]>([])
  isChecking = $state(false)
  /** Why the request to the service failed. */
  problem = $state.raw<ProblemError>()
  /** The member to show in the text. */
  shown = $state.raw<{ path: Path }>()
  #timer: ReturnType<typeof setTimeout> | undefined
  #asked = 0
  #lastFile: TomlFile | undefined

  constructor() {
    const kept = read()
    if (kept === undefined) return
    this.#history = History.of(kept.text)
    this.#first = kept.text
    this.#saved = kept.saved
    this.source = kept.source
    this.isOwn = kept.isOwn
    this.origin = kept.origin
  }

  get isOpen(): boolean {
    return this.#history !== undefined
  }

  get text(): string {
    return this.#history?.text ?? ''
  }

  /** The parsed text, or its parse error. */
  readonly read: { file?: TomlFile; error?: TomlError } = $derived.by(() => {
    try {
      return { file: new TomlFile(this.text) }
    } catch (error) {
      if (!(error instanceof TomlError)) throw error
      return { error }
    }
  })

  /**
   * The last readable version of the file, which the forms show while the text is not valid TOML.
   */
  readonly file: TomlFile = $derived.by(() => {
    const { file } = this.read
    if (file !== undefined) this.#lastFile = file
    return file ?? this.#lastFile ?? new TomlFile('')
  })

  readonly draft: Draft = $derived(draftOf(this.file.value))

  /** The network as it was opened. */
  readonly firstDraft: Draft = $derived(draftOf(valueOf(this.#first)))

  readonly findings: readonly Finding[] = $derived.by(() => {
    const { error } = this.read
    return error === undefined ? this.#checked : [ofSyntax(error)]
  })

  /** Whether forms can change the text. */
  get isEditable(): boolean {
    return this.read.file !== undefined
  }

  get isChanged(): boolean {
    return this.text !== this.#saved
  }

  get isSound(): boolean {
    return (
      this.info !== undefined && !this.isChecking && this.findings.every(({ kind }) => kind === 'warning')
    )
  }

  get canUndo(): boolean {
    return this.#history?.canUndo === true
  }

  get canRedo(): boolean {
    return this.#history?.canRedo === true
  }

  /** Opens a network for editing. */
  open({ toml, source, isOwn }: Opened): void {
    this.#history = History.of(toml)
    this.#first = toml
    this.#saved = toml
    this.source = source
    this.isOwn = isOwn
    this.origin = source === '' ? undefined : { name: source, toml }
    this.opened += 1
    this.vertiport = undefined
    this.info = undefined
    this.#checked = []
    this.shown = undefined
    this.#changed(0)
  }

  /** Replaces the whole text. */
  type(text: string, key = 'text'): void {
    this.#history = this.#history?.then(text, key, Date.now())
    this.#changed()
  }

  /** Changes the file; consecutive changes with the same `key` are one undo step. */
  change(splices: (file: TomlFile) => Splice[], key = ''): void {
    const { file } = this.read
    if (file !== undefined) this.type(apply(file.text, splices(file)), key)
  }

  set(path: Path, value: Literal): void {
    this.change((file) => set(file, path, value), path.join('.'))
    this.shown = { path }
  }

  /** Sets a text, or removes the member if it is empty. */
  setOrRemove(path: Path, value: string): void {
    if (value !== '') this.set(path, value)
    else this.change((file) => remove(file, path))
  }

  undo(): void {
    this.#history = this.#history?.undo()
    this.#changed()
  }

  redo(): void {
    this.#history = this.#history?.redo()
    this.#changed()
  }

  /** The value of a member, if it is there. */
  value(path: Path): unknown {
    return member(this.file.value, path)
  }

  finding(path: Path): Finding | undefined {
    return findingAt(this.findings, path)
  }

  /** Shows a member: in its form where there is one, and in the text. */
  show(path: Path): void {
    const [first, second] = path
    this.tab = tabOf[String(first)] ?? 'days'
    if (first === 'vertiports' && typeof second === 'number') this.vertiport = second
    this.shown = { path }
  }

  /** Shows a member in the text, which is opened if it is hidden. */
  reveal(path: Path): void {
    this.showsText = true
    if (this.isNarrow) this.tab = 'text'
    this.shown = { path }
  }

  /** The member on a line; empty if there is none. */
  pathOfLine(line: number): Path {
    const lines = this.text.split('\n').slice(0, line - 1)
    const begin = lines.reduce((offset, one) => offset + one.length + 1, 0)
    return this.file.pathAt(begin)
  }

  /** Checks the text with the service at once. */
  async check(): Promise<void> {
    clearTimeout(this.#timer)
    const { file } = this.read
    const asked = ++this.#asked
    if (file === undefined) {
      this.isChecking = false
      return
    }
    this.isChecking = true
    try {
      const info = await session.service.validateNetwork(file.text)
      if (asked !== this.#asked) return
      this.info = info
      this.#checked = info.warnings.map((warning) => findingOfWarning(warning, file))
      this.problem = undefined
    } catch (cause) {
      if (asked === this.#asked) this.#refused(cause, file)
    }
    if (asked === this.#asked) this.isChecking = false
  }

  /** Saves the network in the service under its name. */
  async save(): Promise<NetworkInfo | undefined> {
    const { text } = this
    try {
      const info = await session.service.keepNetwork(this.draft.name, text)
      this.#saved = text
      this.source = info.name
      this.isOwn = true
      // A copy under another name keeps the origin of the original.
      if (this.origin === undefined || this.origin.name === info.name)
        this.origin = { name: info.name, toml: text }
      this.#keep()
      return info
    } catch (cause) {
      toasts.fail(cause)
      return undefined
    }
  }

  /** Deletes the network from the service. Its text stays here, unsaved. */
  async remove(): Promise<boolean> {
    try {
      await session.service.forgetNetwork(this.source)
    } catch (cause) {
      toasts.fail(cause)
      return false
    }
    this.#saved = ''
    this.source = ''
    this.isOwn = false
    this.#keep()
    return true
  }

  #refused(cause: unknown, file: TomlFile): void {
    if (!(cause instanceof ProblemError)) throw cause
    // Without permission or an answer, the text itself is not marked as wrong.
    const isAboutTheText = cause.status === 400 || cause.status === 422
    this.problem = isAboutTheText ? undefined : cause
    if (isAboutTheText) this.#checked = [findingOf(cause, file)]
  }

  #changed(pause_ms = PAUSE_MS): void {
    this.#keep()
    this.isChecking = true
    clearTimeout(this.#timer)
    this.#timer = setTimeout(() => void this.check(), pause_ms)
  }

  #keep(): void {
    const { text, source, isOwn, origin } = this
    const kept: Kept = { text, saved: this.#saved, source, isOwn, origin }
    try {
      if (kept.text.length <= MOST_KEPT) sessionStorage.setItem(KEY, JSON.stringify(kept))
      else sessionStorage.removeItem(KEY)
    } catch {
      // The network is kept until the page is closed.
    }
  }
}

/** The values of a text; undefined if it is not valid TOML. */
function valueOf(text: string): unknown {
  try {
    return new TomlFile(text).value
  } catch {
    return {}
  }
}

function ofSyntax(error: TomlError): Finding {
  return { kind: 'error', code: '', message: error.message, hint: undefined, path: [], line: error.line }
}

function read(): Kept | undefined {
  try {
    return JSON.parse(sessionStorage.getItem(KEY) ?? '') as Kept
  } catch {
    return undefined
  }
}

export const editor = new Editor()
