// Measurements and pictures of the console for the book. They are not tests, so they do not run
// with the tests. `npm run figures` prints the figures of docs/src/benchmarks.md; scripts/pictures
// writes the pictures of the book.

import { defineConfig } from '@playwright/test'
import tests from './playwright.config.ts'

export default defineConfig({
  ...tests,
  testDir: 'figures',
  timeout: 1_800_000,
  use: { ...tests.use, screenshot: 'off', trace: 'off' },
})
