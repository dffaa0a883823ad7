// Builds dist/replay.html: one file with everything in it, which reports copy and fill with their
// days. It opens from disk without a server, so it must not need other files.

import { svelte } from '@sveltejs/vite-plugin-svelte'
import { defineConfig, type Plugin } from 'vite'
import { noBasemap } from './basemap/plugin.ts'
import { noticesOf } from './licences.ts'

/**
 * Inlines scripts and styles into the page. A module script runs after the page is parsed,
 * regardless of its position.
 */
function inline(): Plugin {
  return {
    name: 'inline',
    enforce: 'post',
    generateBundle(_options, bundle) {
      const page = bundle['replay.html']
      if (page?.type !== 'asset') throw new Error('there is no replay.html in the bundle')
      const notices = `<script type="text/plain" id="licences">${ended(noticesOf(bundle))}</script>`
      let html = String(page.source).replace('</body>', () => `  ${notices}\n  </body>`)
      for (const [name, file] of Object.entries(bundle)) {
        if (file === page) continue
        html =
          file.type === 'chunk'
            ? withScript(html, name, file.code)
            : withStyle(html, name, String(file.source))
        // eslint-disable-next-line @typescript-eslint/no-dynamic-delete -- it removes the file.
        delete bundle[name]
      }
      if (/(?:src|href)="\.?\//.test(html)) throw new Error('replay.html still asks for other files')
      page.source = html
    },
  }
}

function withScript(html: string, name: string, code: string): string {
  return replaced(
    html,
    new RegExp(`<script[^>]*${quoted(name)}"[^>]*></script>`),
    `<script type="module">${ended(code)}</script>`,
  )
}

/** The text of a script must not contain its closing tag. */
function ended(text: string): string {
  return text.replaceAll('</script', '<\\/script')
}

function withStyle(html: string, name: string, code: string): string {
  return replaced(html, new RegExp(`<link[^>]*${quoted(name)}"[^>]*>`), `<style>${code}</style>`)
}

function replaced(html: string, element: RegExp, text: string): string {
  if (!element.test(html)) throw new Error(`replay.html has no element ${String(element)}`)
  return html.replace(element, () => text)
}

function quoted(text: string): string {
  return text.replace(/[.*+?^${}()|[\]\\]/g, '\\$&')
}

export default defineConfig({
  define: { __EMBEDDED__: 'true' },
  plugins: [svelte(), noBasemap(), inline()],
  base: './',
  build: {
    target: 'es2022',
    outDir: 'dist',
    emptyOutDir: false,
    assetsInlineLimit: Number.MAX_SAFE_INTEGER,
    cssCodeSplit: false,
    modulePreload: false,
    reportCompressedSize: false,
    chunkSizeWarningLimit: 4000,
    rolldownOptions: { input: 'replay.html', output: { codeSplitting: false } },
  },
  worker: { format: 'iife' },
})
