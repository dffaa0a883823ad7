// Builds the console: index.html, and files with a hash of their content in their names, so that
// the same sources give the same bytes. Development and tests reach the service through a proxy at
// VERTIFLEET_URL.

import { svelte } from '@sveltejs/vite-plugin-svelte'
import { defineConfig, type ProxyOptions } from 'vite'
import { basemap } from './basemap/plugin.ts'
import { licences } from './licences.ts'
import { contentSecurityPolicy } from './security.ts'

const service = process.env['VERTIFLEET_URL'] ?? 'http://127.0.0.1:8080'
const proxy: Record<string, ProxyOptions> = {
  '/v1': {
    target: service,
    changeOrigin: true,
    configure: (proxy) =>
      proxy.on('proxyRes', (from, _request, response) => {
        // The headers of a stream must not wait for its first event.
        setImmediate(() => response.flushHeaders())
        // If the service was killed, its streams end too.
        from.on('close', () => {
          if (!from.complete) response.destroy()
        })
      }),
  },
}

export default defineConfig({
  define: { __EMBEDDED__: 'false' },
  plugins: [svelte(), basemap(), licences()],
  build: {
    target: 'es2022',
    outDir: 'dist',
    // No file is inlined as a data: address, because the content security policy forbids them.
    assetsInlineLimit: 0,
    modulePreload: { polyfill: false },
    reportCompressedSize: false,
    chunkSizeWarningLimit: 1200,
  },
  worker: { format: 'es' },
  server: { proxy },
  preview: { proxy, headers: { 'Content-Security-Policy': contentSecurityPolicy } },
})
