// Starts the page that reports embed: the replay of days contained in the page, without a service.

import { mount } from 'svelte'
import './style.css'
import Embedded from './replay/Embedded.svelte'

const [target, element] = [document.getElementById('replay'), document.getElementById('vertifleet-data')]
if (target === null || element === null)
  throw new Error('replay.html has the elements #replay and #vertifleet-data')
mount(Embedded, { target, props: { data: element.textContent } })
