// Tests of the pure parts. They run in Node: what needs a browser is tested by Playwright in tests/.

import { svelte } from '@sveltejs/vite-plugin-svelte'
import { defineConfig } from 'vitest/config'
import { noBasemap } from './basemap/plugin.ts'

export default defineConfig({
  define: { __EMBEDDED__: 'true' },
  plugins: [svelte(), noBasemap()],
  test: { include: ['src/**/*.test.ts', 'basemap/**/*.test.ts'], environment: 'node' },
})
