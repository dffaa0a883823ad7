import { describe, expect, it } from 'vitest'
import paperQuick from '../../../../networks/paper-quick.toml?raw'
import { draftOf, member } from './draft'
import { apply, remove, set } from './edits'
import { TomlFile } from './toml'

const CURVE = 'charge_curve = [[0, 300], [0.8, 240.5], [1, 60]]   # from the maker'
const text = paperQuick.replace(/^charge_kw = .*$/m, (line) => `${line}\nreserve_kwh = 20\n${CURVE}`)
const file = new TomlFile(text)

function read(text: string): unknown {
  return new TomlFile(text).value
}

describe('a network that charges as needed', () => {
  it('has the reserve and the curve of its types', () => {
    const [type] = draftOf(read(text)).types
    expect(type?.numbers).toMatchObject({ reserve_kwh: 20, charge_kw: 150 })
    expect(type?.numbers['turnaround_s']).toBeUndefined()
    expect(type?.curve).toEqual([
      [0, 300],
      [0.8, 240.5],
      [1, 60],
    ])
  })

  it('has no curve without one', () => {
    expect(draftOf(read(paperQuick)).types[0]?.curve).toEqual([])
  })

  it('keeps its curve when another member of the type changes', () => {
    const changed = apply(text, set(file, ['aircraft_types', 0, 'turnaround_s'], 300))
    expect(changed).toContain(`${CURVE}\n`)
    expect(member(read(changed), ['aircraft_types', 0, 'turnaround_s'])).toBe(300)
  })

  it('charges to full without the member of the operations', () => {
    const path = ['operations', 'charging']
    expect(member(read(text), path)).toBe('as_needed')
    expect(member(read(apply(text, remove(file, path))), path)).toBeUndefined()
  })
})
