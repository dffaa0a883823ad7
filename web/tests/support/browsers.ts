// The browsers of the tests: a pinned Chromium for all of them; the oldest supported Chromium and
// Firefox for a few. Playwright needs a patched Firefox, so those few use WebDriver BiDi.

import { existsSync } from 'node:fs'
import { resolve } from 'node:path'
import puppeteer, { type Browser } from 'puppeteer-core'

function unpacked(age: 'newest' | 'oldest'): string {
  return resolve('browsers/unpacked', age, 'chromium')
}

/** The name in Debian, and the one in Ubuntu. */
const firefox = ['/usr/bin/firefox-esr', '/usr/bin/firefox'].find((path) => existsSync(path))

/** The browser of all tests and pictures. */
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
