// Unit tests. They run in Node; Playwright tests in tests/ cover everything that needs a browser.

import { svelte } from '@sveltejs/vite-plugin-svelte'
import { defineConfig } from 'vitest/config'
import { noBasemap } from './basemap/plugin.ts'

export default defineConfig({
  define: { __EMBEDDED__: 'true' },
  plugins: [svelte(), noBasemap()],
  test: { include: ['src/**/*.test.ts', 'basemap/**/*.test.ts'], environment: 'node' },
})
