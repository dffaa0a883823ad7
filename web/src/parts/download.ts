// Offers a text to the user as a file.

/** Saves a text in the browser's download folder. */
export function download(content: string, name: string, type: string): void {
  const link = document.createElement('a')
  link.href = URL.createObjectURL(new Blob([content], { type }))
  link.download = name
  link.click()
  URL.revokeObjectURL(link.href)
}
