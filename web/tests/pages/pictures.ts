// A page with one picture of a day, for tests. The address contains the picture, the day and the
// time, for example
// `pictures.html?picture=map&scenario=/d/paper.json&trace=/d/paper.csv&at=08:00:00&speed=60`.

import { mount } from 'svelte'
import '../../src/style.css'
import Pictures from './Pictures.svelte'

const target = document.getElementById('pictures')
if (target === null) throw new Error('the page has an element for pictures')
mount(Pictures, { target })
