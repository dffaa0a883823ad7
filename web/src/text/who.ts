// Who did something, in words that claim no more than the service knows: the person, by the name of the token, and the policy whose
// advice was taken. Without tokens no user has a name, and an acceptance by a person looks like that of a program; only what was done at
// this console is known to be the reader's own.

import { text } from './text'

export interface Doing {
  /** The name of the token; empty without tokens. */
  actor: string
  /** The policy whose advice was taken; absent where a person chose, and for what is no decision. */
  policy?: string | null | undefined
  /** Whether it was done at this console. */
  isOwn?: boolean
}

/** `anna · prices`, `you · prices`, `as prices advised`; empty if nothing is known. */
export function whoDid({ actor, policy, isOwn = false }: Doing): string {
  const person = actor !== '' ? actor : isOwn ? text.decided.you : ''
  if (person === '') return policy == null ? '' : text.decided.asAdvised(policy)
  return policy == null ? person : `${person} · ${policy}`
}

/** The same of a decision: where no policy advised it, a person chose. */
export function whoDecided(doing: Doing): string {
  return whoDid(doing) || text.decided.person
}

/** Why no name is given, if that is so. */
export function whyNoName({ actor, isOwn = false }: Doing): string | undefined {
  return actor === '' && !isOwn ? text.decided.noNameHint : undefined
}
