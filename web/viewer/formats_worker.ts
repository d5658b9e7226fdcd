// The script of workers with the engine's program that reads all formats and writes files: that of loaders, and the
// decompression that the program needs.

import { codecs } from './codecs.js';
import { useCodecs } from './engine.js';
import './loader_worker.js';

useCodecs(codecs);
