// Gives a text to the person as a file.

/** Saves a text where the browser keeps what is downloaded. */
export function download(content: string, name: string, type: string): void {
  const link = document.createElement('a')
  link.href = URL.createObjectURL(new Blob([content], { type }))
  link.download = name
  link.click()
  URL.revokeObjectURL(link.href)
}
