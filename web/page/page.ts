// The page as a site serves it: engine, worker and gallery lie beside it.

import { openViewerPage } from './viewer_page.js';

void openViewerPage();
