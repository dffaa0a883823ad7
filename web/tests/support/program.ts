// The real program, started for one test with a temporary folder. The test can stop and restart it.

import { execFileSync, spawn, type ChildProcess } from 'node:child_process'
import { mkdtempSync, rmSync, writeFileSync } from 'node:fs'
import { tmpdir } from 'node:os'
import { join, resolve } from 'node:path'
import { preview, type PreviewServer } from 'vite'

export const program = resolve(process.env['VERTIFLEET_PROGRAM'] ?? '../target/checked/release/vertifleet')
/** A folder from which the console is served instead of the program. */
const previewed = process.env['VERTIFLEET_PREVIEW']

export class Program {
  readonly #folder = mkdtempSync(join(tmpdir(), 'vertifleet-console-'))
  #process: ChildProcess | undefined
  readonly #operators: ChildProcess[] = []
  #port = 0
  #preview: PreviewServer | undefined

  private constructor(private readonly more: readonly string[]) {}

  /**
   * Starts the service; `more` contains arguments in addition to the address and the data folder.
   */
  static async start(...more: string[]): Promise<Program> {
    const started = new Program(more)
    await started.run()
    if (previewed !== undefined) await started.#servePreview(resolve(previewed))
    return started
  }

  /** The address of the service. */
  get url(): string {
    return `http://127.0.0.1:${this.#port}`
  }

  /** The address of the console. */
  get console(): string {
    const address = this.#preview?.httpServer.address()
    return typeof address === 'object' && address !== null ? `http://127.0.0.1:${address.port}` : this.url
  }

  /** Starts the service; after a stop it gets the same address. */
  async run(): Promise<void> {
    const address = `127.0.0.1:${this.#port}`
    const child = spawn(program, ['serve', '--listen', address, '--data', this.#folder, ...this.more])
    this.#process = child
    this.#port = await new Promise<number>((listens, fails) => {
      let output = ''
      const read = (bytes: Buffer) => {
        output += bytes.toString()
        const found = /http:\/\/127\.0\.0\.1:(\d+)/.exec(output)
        if (found?.[1] !== undefined) listens(Number(found[1]))
      }
      child.stdout.on('data', read)
      child.stderr.on('data', read)
      child.on('error', fails)
      child.on('exit', () => fails(new Error(`the program ended: ${output}`)))
    })
  }

  async kill(signal: NodeJS.Signals = 'SIGKILL'): Promise<void> {
    const child = this.#process
    if (child === undefined || child.exitCode !== null || child.signalCode !== null) return
    const ended = new Promise((resume) => child.once('exit', resume))
    child.kill(signal)
    await ended
  }

  /**
   * Runs `vertifleet operate`, which reports a day of a network to its end. Returns its error, or
   * an empty text.
   */
  operate(network: string, ...args: string[]): Promise<string> {
    const file = join(this.#folder, 'operated.toml')
    writeFileSync(file, network)
    const child = spawn(program, ['operate', this.url, '--network', file, ...args])
    this.#operators.push(child)
    let output = ''
    child.stderr.on('data', (bytes: Buffer) => (output += bytes.toString()))
    return new Promise((ends) => child.once('close', (code) => ends(code === 0 ? '' : `${code}: ${output}`)))
  }

  /** Creates a token, after which every request needs one. */
  token(role: 'read' | 'dispatch' | 'admin'): string {
    const args = [
      'serve',
      'token',
      'make',
      '--name',
      `${role}-console`,
      '--role',
      role,
      '--data',
      this.#folder,
    ]
    const output = execFileSync(program, args, { encoding: 'utf8' })
    const token = /vf_\S+/.exec(output)?.[0]
    if (token === undefined) throw new Error(`no token in: ${output}`)
    return token
  }

  async stop(): Promise<void> {
    for (const operator of this.#operators) operator.kill()
    await this.kill()
    await this.#preview?.close()
    rmSync(this.#folder, { recursive: true, force: true })
  }

  async #servePreview(outDir: string): Promise<void> {
    process.env['VERTIFLEET_URL'] = this.url
    this.#preview = await preview({
      build: { outDir },
      preview: { port: 0, host: '127.0.0.1' },
      logLevel: 'silent',
    })
  }
}
