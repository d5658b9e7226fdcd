// The page of a site: engine, worker and gallery are separate files next to it.

import { openViewerPage } from './viewer_page.js';

void openViewerPage();
