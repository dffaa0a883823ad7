// The hovered and the selected object, and the followed aircraft. A page has only one selection, so
// the lists, the map and the timelines show the same.

import { aircraftMeant, isSame, vertiportMeant, type Target } from '../model/target'

export class Selection {
  hovered = $state.raw<Target>()
  selected = $state.raw<Target>()
  /** The aircraft that the map and the timeline keep in view, whatever is selected. */
  followed = $state<number>()

  get aircraft(): number | undefined {
    return aircraftMeant(this.selected)
  }

  get vertiport(): number | undefined {
    return vertiportMeant(this.selected)
  }

  hover(target: Target | undefined): void {
    if (!isSame(target, this.hovered)) this.hovered = target
  }

  select(target: Target | undefined): void {
    if (!isSame(target, this.selected)) this.selected = target
  }

  /** Selects an aircraft, and keeps it in view until following ends. */
  follow(aircraft: number): void {
    this.select({ kind: 'aircraft', aircraft })
    this.followed = aircraft
  }

  stopFollowing(): void {
    this.followed = undefined
  }

  isHovered(target: Target): boolean {
    return isSame(target, this.hovered)
  }

  isSelected(target: Target): boolean {
    return isSame(target, this.selected)
  }
}
