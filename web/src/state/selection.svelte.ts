// The hovered and the selected object. A page has only one selection, so the lists, the map and the
// timelines show the same.

import { aircraftMeant, isSame, vertiportMeant, type Target } from '../model/target'

export class Selection {
  hovered = $state.raw<Target>()
  selected = $state.raw<Target>()

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

  isHovered(target: Target): boolean {
    return isSame(target, this.hovered)
  }

  isSelected(target: Target): boolean {
    return isSame(target, this.selected)
  }
}
