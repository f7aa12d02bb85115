// Right after the summary: tells when the browser has painted it, which it does before it reads on.

import { shown } from "./shown.js";

window.fpcadPainted = shown();
