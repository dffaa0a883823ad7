// Whether this machine has a graphics processor that a page can use. A browser without one draws WebGL on the main processor, and
// then plain canvases are faster; docs/console.md has the measurement.

const SOFTWARE = /swiftshader|llvmpipe|softpipe|software|basic render/i

export function hasGraphicsProcessor(): boolean {
  const context = document.createElement('canvas').getContext('webgl2')
  if (context === null) return false
  const renderer = rendererOf(context)
  context.getExtension('WEBGL_lose_context')?.loseContext()
  return !SOFTWARE.test(renderer)
}

function rendererOf(context: WebGL2RenderingContext): string {
  const names = context.getExtension('WEBGL_debug_renderer_info')
  return String(context.getParameter(names?.UNMASKED_RENDERER_WEBGL ?? context.RENDERER))
}
