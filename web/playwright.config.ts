// Tests of the console against the real program: VERTIFLEET_PROGRAM, or the one that `cargo build`
// made. They run in the pinned Chromium of `browsers/`, or in VERTIFLEET_CHROMIUM.
//
// With VERTIFLEET_PREVIEW=dist the console is served from that folder instead of the program. The
// program then needs no rebuild after a change of the console.

import { defineConfig } from '@playwright/test'
import { chromium } from './tests/support/browsers'

export default defineConfig({
  testDir: 'tests',
  // Tests wait for states, not for times, so two can share the cores of a small machine.
  workers: 2,
  timeout: 120_000,
  expect: { timeout: 20_000 },
  reporter: [['list']],
  outputDir: 'test-results',
  use: {
    viewport: { width: 1280, height: 800 },
    // Wall-clock times are displayed with their time zone.
    timezoneId: 'UTC',
    launchOptions: {
      executablePath: chromium,
      // Software rendering is many times faster without an emulated graphics processor.
      args: ['--no-sandbox', '--disable-gpu'],
    },
    screenshot: 'only-on-failure',
    trace: 'retain-on-failure',
  },
})
