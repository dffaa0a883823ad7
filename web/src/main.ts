// Starts the console.

import { mount } from 'svelte'
import App from './App.svelte'
import './style.css'

const target = document.getElementById('console')
if (target === null) throw new Error('index.html has an element #console')
mount(App, { target })
