// Unpacks the browsers of this folder's packages into `unpacked/newest` and `unpacked/oldest`. The
// packages' own code would unpack both to the same folder.

import { execFileSync } from 'node:child_process'
import { chmodSync, existsSync, mkdirSync, readFileSync, renameSync, rmSync, writeFileSync } from 'node:fs'
import { join } from 'node:path'
import { brotliDecompressSync } from 'node:zlib'

const folder = import.meta.dirname

for (const age of ['newest', 'oldest']) {
  const [packed, unpacked] = [join(folder, 'node_modules', `chromium-${age}`), join(folder, 'unpacked', age)]
  const { version } = JSON.parse(readFileSync(join(packed, 'package.json'), 'utf8'))
  if (existsSync(join(unpacked, version))) continue
  const making = `${unpacked}.making`
  for (const old of [making, unpacked]) rmSync(old, { recursive: true, force: true })
  mkdirSync(making, { recursive: true })
  const unpack = (file) => brotliDecompressSync(readFileSync(join(packed, 'bin', file)))
  writeFileSync(join(making, 'chromium'), unpack('chromium.br'))
  chmodSync(join(making, 'chromium'), 0o755)
  // WebGL on the main processor.
  execFileSync('tar', ['-x', '-C', making], { input: unpack('swiftshader.tar.br') })
  writeFileSync(join(making, version), '')
  renameSync(making, unpacked)
}
