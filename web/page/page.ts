// The page as a site serves it: engine, worker and gallery lie beside it.

import { openRoom } from './room.js';

void openRoom();
