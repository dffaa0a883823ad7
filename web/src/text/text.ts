// The only access to user texts. Another language is a file with the same members as `en`.

import { en } from './en'

type Texts = typeof en

export const text: Texts = en
