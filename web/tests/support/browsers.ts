// The browsers of the tests: a pinned Chromium for all of them, and the oldest Chromium and the Firefox that are supported for a few.
// Playwright needs a Firefox of its own, so those few go by WebDriver BiDi.

import { existsSync } from 'node:fs'
import { resolve } from 'node:path'
import puppeteer, { type Browser } from 'puppeteer-core'

function unpacked(age: 'newest' | 'oldest'): string {
  return resolve('browsers/unpacked', age, 'chromium')
}

/** Debian's name for it, and Ubuntu's. */
const firefox = ['/usr/bin/firefox-esr', '/usr/bin/firefox'].find((path) => existsSync(path))

/** What all tests run in, and pictures are taken with. */
export const chromium = process.env['VERTIFLEET_CHROMIUM'] ?? unpacked('newest')

export const others = {
  'the oldest Chromium': () =>
    puppeteer.launch({ executablePath: unpacked('oldest'), args: ['--no-sandbox', '--disable-gpu'] }),
  Firefox: () =>
    puppeteer.launch({
      browser: 'firefox',
      executablePath: process.env['VERTIFLEET_FIREFOX'] ?? firefox ?? 'firefox',
    }),
} as const satisfies Record<string, () => Promise<Browser>>
