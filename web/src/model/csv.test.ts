import { expect, it } from 'vitest'
import { parseCsv } from './csv'

it('reads quoted fields with commas, quotes and line ends in them', () => {
  expect(parseCsv('a,b\r\n"x, y","say ""so"""\n\n"two\nlines",\n')).toEqual([
    ['a', 'b'],
    ['x, y', 'say "so"'],
    ['two\nlines', ''],
  ])
})

it('reads a last line without an end', () => {
  expect(parseCsv('a,b\n1,2')).toEqual([
    ['a', 'b'],
    ['1', '2'],
  ])
})
