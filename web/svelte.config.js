// Svelte's settings, which Vite, svelte-check and eslint share.
import { vitePreprocess } from '@sveltejs/vite-plugin-svelte'

export default {
  preprocess: vitePreprocess(),
  compilerOptions: {
    runes: true,
    // Styles go into files of their own: the content security policy permits none in the page.
    css: 'external',
  },
}
