// Makes the base map when the console is built: a file for each sector, and a module with their
// addresses. The data is not in this repository but in npm packages. The same packages always give
// the same bytes.

import { createHash } from 'node:crypto'
import type { Plugin } from 'vite'
import { sectors } from './cells.ts'

const MODULE = 'virtual:basemap'
const RESOLVED = `\0${MODULE}`
/** The address of the sectors on the development server. */
const DEVELOPED = '/basemap/'

export function basemap(): Plugin {
  let isServing = false
  let kept: Map<string, string> | undefined
  const all = () => (kept ??= sectors())
  return {
    name: 'basemap',
    configResolved: (config) => {
      isServing = config.command === 'serve'
    },
    resolveId: (id) => (id === MODULE ? RESOLVED : undefined),
    load(id) {
      if (id !== RESOLVED) return undefined
      const addresses = [...all()].map(([name, source]) => {
        if (isServing) return `${JSON.stringify(name)}: ${JSON.stringify(`${DEVELOPED}${name}.json`)}`
        const reference = this.emitFile({ type: 'asset', fileName: fileOf(name, source), source })
        return `${JSON.stringify(name)}: import.meta.ROLLUP_FILE_URL_${reference}`
      })
      return `export const addresses = {${addresses.join(', ')}}`
    },
    configureServer: (server) => {
      server.middlewares.use(DEVELOPED, (request, response, next) => {
        const text = all().get((request.url ?? '').replace(/^\/|\.json$/g, ''))
        if (text === undefined) next()
        else response.setHeader('Content-Type', 'application/json').end(text)
      })
    },
  }
}

/**
 * File names contain a hash of the content, because browsers cache these files forever. Sectors
 * have a separate folder, from which reports read the ones they need.
 */
function fileOf(name: string, source: string): string {
  const hash = createHash('sha256').update(source).digest('base64url').slice(0, 8)
  return `assets/basemap/${name}-${hash}.json`
}

/** For pages that embed their base map: no sector has an address. */
export function noBasemap(): Plugin {
  return {
    name: 'no-basemap',
    resolveId: (id) => (id === MODULE ? RESOLVED : undefined),
    load: (id) => (id === RESOLVED ? 'export const addresses = {}' : undefined),
  }
}
