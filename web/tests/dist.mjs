// Checks that dist/, which is in the repository and in the program, matches its sources. It builds
// the console into a temporary folder and compares all files byte for byte.

import { execFileSync } from 'node:child_process'
import { mkdtempSync, readdirSync, readFileSync, rmSync, statSync } from 'node:fs'
import { tmpdir } from 'node:os'
import { join } from 'node:path'
import { fileURLToPath } from 'node:url'

const web = fileURLToPath(new URL('..', import.meta.url))
const kept = join(web, 'dist')
const built = mkdtempSync(join(tmpdir(), 'vertifleet-dist-'))

try {
  for (const config of ['vite.config.ts', 'vite.replay.config.ts'])
    execFileSync('npx', ['vite', 'build', '--config', config, '--outDir', built, '--logLevel', 'error'], {
      cwd: web,
      stdio: 'inherit',
    })
  const faults = compare(filesOf(kept), filesOf(built))
  if (faults.length > 0) {
    console.error(`dist/ is not what its sources build:\n${faults.map((one) => `  ${one}`).join('\n')}`)
    console.error('`make console` makes it new; commit what it changes.')
    process.exitCode = 1
  } else console.log(`dist/ is what its sources build: ${filesOf(built).length} files are the same.`)
} finally {
  rmSync(built, { recursive: true, force: true })
}

/** All files of a folder, as relative paths. */
function filesOf(folder) {
  return readdirSync(folder, { recursive: true })
    .filter((path) => statSync(join(folder, path)).isFile())
    .sort()
}

/** The differences between the stored files and the built ones. */
function compare(before, now) {
  const isSame = (path) => readFileSync(join(kept, path)).equals(readFileSync(join(built, path)))
  return [
    ...before.filter((path) => !now.includes(path)).map((path) => `${path} is not built any more`),
    ...now.filter((path) => !before.includes(path)).map((path) => `${path} is missing`),
    ...now.filter((path) => before.includes(path) && !isSame(path)).map((path) => `${path} differs`),
  ]
}
