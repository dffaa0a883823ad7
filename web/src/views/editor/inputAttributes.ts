// What the input of a field of the file has to carry, whatever it takes: it is found by its path and described by what stands around it.

export interface InputAttributes {
  id: string
  /** The path of the member, as JSON. */
  'data-path': string
  'aria-invalid': boolean
  'aria-describedby': string | undefined
  onfocus: () => void
}
