// The network that is being edited: its text, and what the service says of it. It outlives the view, so that a look at a day loses
// nothing, and the tab keeps it until it is closed.

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

/** A pause in typing after which the service is asked. */
const PAUSE_MS = 350
const KEY = 'vertifleet-network'
/** Larger texts are not kept for a tab that is loaded again. */
const MOST_KEPT = 1_000_000

export type Tab = 'places' | 'fleet' | 'tariffs' | 'demand' | 'days' | 'text'

/** Which part of the forms a member is edited in, by its first step. */
const tabOf: Readonly<Record<string, Tab>> = {
  vertiports: 'places',
  aircraft_types: 'fleet',
  fleet: 'fleet',
  tariffs: 'tariffs',
  demand: 'demand',
  daily_demand: 'demand',
  hourly_demand: 'demand',
  uniform_demand: 'demand',
}

/** A network to edit. */
export interface Opened {
  toml: string
  /** Its name in the service; empty if it is not there. */
  source: string
  /** Whether the service has it because it was saved, rather than shipped with it. */
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
  /** The text as it was read or saved last. */
  #saved = $state('')
  #first = $state('')
  /** The network of the service that it was read from or saved as; empty if it is not there. */
  source = $state('')
  isOwn = $state(false)
  /** The saved network that it came from, and that its changes are measured against; a new one has none until it is saved. */
  origin = $state.raw<NetworkText>()
  tab = $state<Tab>('places')
  /** Whether the text stands beside the forms, or takes a tab of its own where there is no room. */
  showsText = $state(true)
  isNarrow = $state(false)
  /** Counts the networks that were opened, so that pictures know when to begin anew. */
  opened = $state(0)
  /** The vertiport that is looked at, on the map and in its form. */
  vertiport = $state<number>()
  info = $state.raw<NetworkInfo>()
  #said = $state.raw<Finding[]>([])
  isChecking = $state(false)
  /** Why the service could not be asked. */
  problem = $state.raw<ProblemError>()
  /** The member that is to be shown in the text. */
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

  /** The text as a file, or why it is none. */
  readonly read: { file?: TomlFile; error?: TomlError } = $derived.by(() => {
    try {
      return { file: new TomlFile(this.text) }
    } catch (error) {
      if (!(error instanceof TomlError)) throw error
      return { error }
    }
  })

  /** The file as it could last be read, which forms show while a person types something that is no TOML yet. */
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
    return error === undefined ? this.#said : [ofSyntax(error)]
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

  /** Begins to edit a network. */
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
    this.#said = []
    this.shown = undefined
    this.#changed(0)
  }

  /** The whole text takes the place of the former one. */
  type(text: string, key = 'text'): void {
    this.#history = this.#history?.then(text, key, Date.now())
    this.#changed()
  }

  /** Changes the file; `key` makes one step of changes that follow each other. */
  change(splices: (file: TomlFile) => Splice[], key = ''): void {
    const { file } = this.read
    if (file !== undefined) this.type(apply(file.text, splices(file)), key)
  }

  set(path: Path, value: Literal): void {
    this.change((file) => set(file, path, value), path.join('.'))
    this.shown = { path }
  }

  /** Sets a text, or takes the member out where it is empty. */
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

  /** Shows a member in the text, which comes forth if it is hidden. */
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

  /** Asks the service about the text at once. */
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
      this.#said = info.warnings.map((warning) => findingOfWarning(warning, file))
      this.problem = undefined
    } catch (cause) {
      if (asked === this.#asked) this.#refused(cause, file)
    }
    if (asked === this.#asked) this.isChecking = false
  }

  /** Keeps the network in the service under its name. */
  async save(): Promise<NetworkInfo | undefined> {
    const { text } = this
    try {
      const info = await session.service.keepNetwork(this.draft.name, text)
      this.#saved = text
      this.source = info.name
      this.isOwn = true
      // A copy under another name still came from the network that it was copied from.
      if (this.origin === undefined || this.origin.name === info.name)
        this.origin = { name: info.name, toml: text }
      this.#keep()
      return info
    } catch (cause) {
      toasts.fail(cause)
      return undefined
    }
  }

  /** Removes the network from the service. Its text stays here, and is not saved any more. */
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
    // Without permission or an answer, nothing is marked wrong in the text.
    const isAboutTheText = cause.status === 400 || cause.status === 422
    this.problem = isAboutTheText ? undefined : cause
    if (isAboutTheText) this.#said = [findingOf(cause, file)]
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
      // It is kept until the page is closed.
    }
  }
}

/** The values of a text; none if it is no TOML. */
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
