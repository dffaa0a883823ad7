import { readFileSync } from 'node:fs'
import { expect, it } from 'vitest'
import { coloured } from './ink'

it('recognises comments, headings, texts and numbers', () => {
  const kinds = coloured(
    '[[fleet]] # all "of" them\ntype = "a # b"\ncount = 1.5\nbusy = true\nlist = [1, 2]\n',
  )
  expect(kinds.filter(({ kind }) => kind !== 'plain').map(({ kind, text }) => `${kind} ${text}`)).toEqual([
    'heading [[fleet]]',
    'remark # all "of" them',
    'string "a # b"',
    'number 1.5',
    'number true',
    'number 1',
    'number 2',
  ])
})

it('leaves nothing out', () => {
  const text = readFileSync(new URL('../../../../networks/new-york.toml', import.meta.url), 'utf8')
  const inks = coloured(text)
  expect(inks.map((one) => one.text).join('')).toBe(text)
})
