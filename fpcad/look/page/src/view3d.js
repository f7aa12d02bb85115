// The script of the 3D view: by far the larger one, so main.js runs it after what the page opens with.

import { GLTFExporter } from "three/addons/exporters/GLTFExporter.js";
import { Stage } from "./stage.js";

window.fpcad3d({ Stage, GLTFExporter });
