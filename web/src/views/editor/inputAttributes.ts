// The attributes of every input for a member of the file: it is found by its path and described by
// its hint and findings.

export interface InputAttributes {
  id: string
  /** The path of the member, as JSON. */
  'data-path': string
  'aria-invalid': boolean
  'aria-describedby': string | undefined
  onfocus: () => void
}
