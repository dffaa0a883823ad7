// Who took an action: the person, by the name of the token, and the policy whose advice was
// accepted. The text claims no more than the service knows. Without tokens users have no names, and
// a person's acceptance looks like a program's. Only actions at this console are known to be the
// user's.

import { text } from './text'

export interface Action {
  /** The name of the token; empty without tokens. */
  actor: string
  /**
   * The policy whose advice was accepted; absent if a person chose, or if the action is not a
   * decision.
   */
  policy?: string | null | undefined
  /** Whether it was done at this console. */
  isOwn?: boolean
}

/** `anna · prices`, `you · prices`, `as prices advised`; empty if nothing is known. */
export function actorText({ actor, policy, isOwn = false }: Action): string {
  const person = actor !== '' ? actor : isOwn ? text.decided.you : ''
  if (person === '') return policy == null ? '' : text.decided.asAdvised(policy)
  return policy == null ? person : `${person} · ${policy}`
}

/** The same for a decision: if no policy advised it, a person chose. */
export function deciderText(action: Action): string {
  return actorText(action) || text.decided.person
}

/** Why no name is given, if there is none. */
export function anonymityHint({ actor, isOwn = false }: Action): string | undefined {
  return actor === '' && !isOwn ? text.decided.noNameHint : undefined
}
