// The 3D view: palm at rest, tool turning in it, contacts with normals and forces.

import {
  AmbientLight, BufferAttribute, BufferGeometry, Color, ConeGeometry, CylinderGeometry, DirectionalLight, Euler,
  Group, HemisphereLight, Matrix4, Mesh, MeshBasicMaterial, MeshStandardMaterial, PerspectiveCamera, Quaternion, Scene, SphereGeometry,
  Vector3, WebGLRenderer,
} from "three";
import { OrbitControls } from "three/addons/controls/OrbitControls.js";
import { Hand } from "./hand.js";
import { make, onResize } from "./dom.js";
import { colour } from "./theme.js";

const MM_PER_N = 1;
const NORMAL_MM = 25;
const VIEW = new Vector3(-0.75, -1, -0.7); // from the palmar side, fingers pointing away
const TARGET = new Vector3(10, 0, -35);
const DISTANCE = 330;

export class Stage {
  constructor(host, run) {
    this.run = run;
    this.renderer = new WebGLRenderer({ antialias: true, alpha: true, preserveDrawingBuffer: true });
    this.canvas = this.renderer.domElement;
    this.canvas.tabIndex = 0;
    this.canvas.setAttribute("role", "img");
    host.append(this.canvas);
    this.scene = new Scene();
    this.camera = new PerspectiveCamera(35, 1, 1, 5000);
    this.camera.up.set(0, 0, 1);
    this.controls = new OrbitControls(this.camera, this.canvas);
    this.controls.addEventListener("change", () => this.render());
    this.canvas.addEventListener("keydown", (event) => this.#key(event));
    this.materials = materials();
    this.inTool = new Group(); // O of the pose, in the hand frame
    this.turned = new Group(); // O turned with the tool
    this.arrows = new Group();
    this.inTool.matrixAutoUpdate = false;
    this.turned.matrixAutoUpdate = false;
    this.turned.add(toolMesh(run.tool, this.materials.tool));
    this.inTool.add(this.turned, this.arrows);
    this.scene.add(this.inTool, ...lights(this.camera), this.camera);
    this.reset();
    onResize(host, (width) => this.#resize(width));
  }

  #resize(width) {
    const height = Math.round(Math.min(width * 0.78, innerHeight * 0.5));
    this.renderer.setPixelRatio(Math.min(devicePixelRatio, 2));
    this.renderer.setSize(width, height);
    this.camera.aspect = width / height;
    this.camera.updateProjectionMatrix();
    this.render();
  }

  reset() {
    this.controls.target.copy(TARGET);
    this.camera.position.copy(VIEW).setLength(DISTANCE).add(TARGET);
    this.controls.update();
    this.render();
  }

  /** Shows the hand of a row. */
  showHand(row) {
    this.hand?.dispose();
    if (this.hand) this.scene.remove(this.hand.group);
    this.hand = new Hand(this.run, row, this.materials);
    this.#showParts(row);
    this.scene.add(this.hand.group);
  }

  setParts(wanted, row) {
    this.wantsParts = wanted;
    this.#showParts(row);
    this.render();
  }

  /** Printed parts are there for the chosen hand alone, and made when somebody asks for them. */
  #showParts(row) {
    if (this.wantsParts && row === this.run.chosen && !this.hand.parts) {
      this.meshes ??= this.run.meshes.map(printedPart);
      this.hand.addMeshes(this.meshes);
    }
    this.hand.showParts(this.wantsParts);
  }

  /** Puts the tool where a motion's hand holds it, before it turns. */
  placeTool(motion) {
    const [roll, pitch, yaw] = motion.rotation;
    const turn = new Quaternion().setFromEuler(new Euler(roll, pitch, yaw, "ZYX"));
    this.inTool.matrix.compose(new Vector3(...motion.position), turn, new Vector3(1, 1, 1)).invert();
  }

  /** Shows one frame of a pose's motion. */
  showFrame(pose, frame) {
    this.hand.setJoints(frame.joints);
    this.turned.matrix.copy(rotationAbout(pose.axis, pose.pivot, frame.turn));
    this.arrows.clear();
    const radius = this.run.tool.radius_mm;
    pose.contacts.forEach((_, i) => {
      const [c, s] = [Math.cos(frame.angle[i]), Math.sin(frame.angle[i])];
      const point = new Vector3(frame.axial[i], radius * c, radius * s).applyMatrix4(this.turned.matrix);
      const normal = new Vector3(0, c, s).transformDirection(this.turned.matrix);
      this.#contact(point, normal, frame.forces && new Vector3(...frame.forces.subarray(3 * i, 3 * i + 3)));
    });
    this.#load(pose, frame);
    this.render();
  }

  #contact(point, normal, force) {
    const dot = new Mesh(DOT, this.materials.contact);
    dot.position.copy(point);
    dot.renderOrder = 1;
    this.arrows.add(dot, arrow(normal, point, NORMAL_MM, "normal"));
    if (force && force.length() > 0.05) {
      const length = force.length() * MM_PER_N;
      const tail = point.clone().addScaledVector(force, -MM_PER_N); // it pushes on the tool
      this.arrows.add(arrow(force.clone().normalize(), tail, length, "force"));
    }
  }

  /** The force at the tip that the hand holds against. */
  #load(pose, frame) {
    const tip = new Vector3(this.run.tool.tip_mm, 0, 0);
    const sweep = new Vector3(...pose.axis).normalize().cross(tip.clone().sub(new Vector3(...pose.pivot)));
    const pull = frame.turn < 0 ? 1 : -1;
    const direction = sweep.normalize().multiplyScalar(pull).transformDirection(this.turned.matrix);
    const length = pose.tip_force * MM_PER_N;
    if (!length) return;
    const end = tip.applyMatrix4(this.turned.matrix);
    this.arrows.add(arrow(direction, end.addScaledVector(direction, -length), length, "load"));
  }

  #key(event) {
    const turns = { ArrowLeft: [-0.1, 0], ArrowRight: [0.1, 0], ArrowUp: [0, -0.1], ArrowDown: [0, 0.1] };
    const zoom = { "+": 0.9, "=": 0.9, "-": 1 / 0.9 }[event.key];
    if (!(event.key in turns) && !zoom) return;
    event.preventDefault();
    const offset = this.camera.position.clone().sub(this.controls.target);
    const [around, up] = turns[event.key] ?? [0, 0];
    const polar = Math.min(Math.max(offset.angleTo(this.camera.up) + up, 0.05), Math.PI - 0.05);
    const azimuth = Math.atan2(offset.y, offset.x) + around;
    const length = offset.length() * (zoom ?? 1);
    offset.set(Math.sin(polar) * Math.cos(azimuth), Math.sin(polar) * Math.sin(azimuth), Math.cos(polar));
    this.camera.position.copy(this.controls.target).addScaledVector(offset, length);
    this.controls.update();
    this.render();
  }

  dispose() {
    this.controls.dispose();
    this.hand?.dispose();
    this.renderer.dispose();
    this.renderer.forceContextLoss();
  }

  describe(text) {
    this.canvas.setAttribute("aria-label", text);
  }

  render() {
    this.renderer.render(this.scene, this.camera);
  }
}

const DOT = new SphereGeometry(1.8, 16, 12);
const SHAFT = new CylinderGeometry(1, 1, 1, 10);
const HEAD = new ConeGeometry(1, 1, 14);

function materials() {
  const solid = (hex) => new MeshStandardMaterial({ color: hex, roughness: 0.75 });
  return {
    palm: solid(0x9aa5ad), link: solid(0xd9d5c8), tip: solid(0xe8b08a), tool: solid(0x4a6a8a),
    contact: new MeshBasicMaterial({ color: 0x111111, depthTest: false, transparent: true }),
  };
}

function lights(camera) {
  const key = new DirectionalLight(0xffffff, 1.6);
  camera.add(key);
  key.position.set(0.5, 1, 1);
  return [new HemisphereLight(0xffffff, 0x777777, 1.2), new AmbientLight(0xffffff, 0.35)];
}

function toolMesh({ radius_mm, back_mm, tip_mm }, material) {
  const mesh = new Mesh(new CylinderGeometry(radius_mm, radius_mm, tip_mm - back_mm, 40), material);
  mesh.rotation.z = Math.PI / 2;
  mesh.position.x = (tip_mm + back_mm) / 2;
  return mesh;
}

function printedPart({ links, colour: rgb, vertices, faces }) {
  const geometry = new BufferGeometry();
  geometry.setAttribute("position", new BufferAttribute(vertices, 3));
  geometry.setIndex(new BufferAttribute(Uint32Array.from(faces), 1));
  const flat = geometry.toNonIndexed(); // sharp edges stay sharp
  flat.computeVertexNormals();
  return { links, geometry: flat, material: new MeshStandardMaterial({ color: new Color(...rgb), roughness: 0.8 }) };
}

/** An arrow that shows through everything: what it tells of lies inside fingers and tool. */
function arrow(direction, origin, length, name) {
  const material = new MeshBasicMaterial({ color: colour(name), depthTest: false, transparent: true });
  const head = Math.min(6, 0.45 * length), shaft = length - head;
  const thick = name === "normal" ? 0.45 : 0.9;
  const parts = [
    [SHAFT, [thick, shaft, thick], shaft / 2],
    [HEAD, [2.6 * thick, head, 2.6 * thick], shaft + head / 2],
  ].map(([geometry, scale, height]) => {
    const part = new Mesh(geometry, material);
    part.scale.set(...scale);
    part.position.y = height;
    return part;
  });
  const group = new Group().add(...parts);
  group.position.copy(origin);
  group.quaternion.setFromUnitVectors(new Vector3(0, 1, 0), direction);
  return group;
}

/** Rotation by an angle [rad] about an axis through a pivot. */
function rotationAbout(axis, pivot, angle) {
  const rotation = new Matrix4().makeRotationAxis(new Vector3(...axis).normalize(), angle);
  const centre = new Vector3(...pivot);
  return rotation.setPosition(centre.clone().sub(centre.clone().applyMatrix4(rotation)));
}
