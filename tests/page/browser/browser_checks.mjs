// All tests in a browser, one after another.
import {after} from 'node:test';
import {close} from './browser.mjs';
import './drawing_checks.mjs';
import './number_checks.mjs';
import './curve_checks.mjs';
import './moving_checks.mjs';
import './load_checks.mjs';
import './machine_checks.mjs';
import './comparison_checks.mjs';
import './look_checks.mjs';
import './verdict_checks.mjs';
import './program_checks.mjs';
import './chart_checks.mjs';
import './scene_checks.mjs';
import './large_checks.mjs';

after(close);
