// Svelte's settings, shared by Vite, svelte-check and eslint.
import { vitePreprocess } from '@sveltejs/vite-plugin-svelte'

export default {
  preprocess: vitePreprocess(),
  compilerOptions: {
    runes: true,
    // Styles are in separate files, because the content security policy forbids them in the page.
    css: 'external',
  },
}
