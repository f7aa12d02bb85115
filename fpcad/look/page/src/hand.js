// A hand of the template as three.js groups: the URDF's frames, its collision shapes, its meshes.

import { CapsuleGeometry, Group, Mesh, SphereGeometry, Vector3 } from "three";

const JOINT_AXES = ["y", "z", "y"]; // of a finger, from the root out; as in the URDF

/** The dimensions of a row: the chosen hand's come before those of all the others. */
function sizesOf({ opening, hand }, row) {
  return opening?.row === row ? { sizes: opening.sizes, index: 0 } : { sizes: hand.sizes, index: row };
}

export class Hand {
  constructor(run, row, material) {
    const { hand } = run;
    const { sizes, index } = sizesOf(run, row);
    this.group = new Group();
    this.links = { palm: this.group };
    this.joints = []; // {group, axis} in the order of the state vector
    this.shapes = new Group();
    const roots = {};
    hand.fingers.forEach((finger, f) => {
      const at = (index * hand.fingers.length + f) * 3, turn = (index * hand.fingers.length + f) * 4;
      roots[finger] = new Vector3(...sizes.root_position.subarray(at, at + 3));
      const [w, x, y, z] = sizes.root_quaternion.subarray(turn, turn + 4);
      this.#finger(finger, roots[finger], [x, y, z, w], sizes, index, material);
    });
    for (const solid of hand.palm) this.#palmSolid(solid, roots, material);
    this.shown = [...this.#shapesOf];
  }

  #shapesOf = [];

  #finger(finger, root, quaternion, sizes, index, material) {
    const radius = sizes.radius[index];
    const base = new Group();
    base.position.copy(root);
    base.quaternion.set(...quaternion);
    this.group.add(base);
    let parent = base;
    ["mcp", "proximal", "distal"].forEach((link, i) => {
      const joint = new Group();
      if (i === 2) joint.position.x = sizes.proximal[index];
      parent.add(joint);
      this.joints.push({ group: joint, axis: JOINT_AXES[i] });
      this.links[`${finger}_${link}`] = parent = joint;
    });
    this.#capsule(this.links[`${finger}_proximal`], new Vector3(), new Vector3(sizes.proximal[index], 0, 0), radius, material.link);
    this.#capsule(this.links[`${finger}_distal`], new Vector3(), new Vector3(sizes.distal[index], 0, 0), radius, material.tip);
  }

  #palmSolid({ start, end, offset, radius }, roots, material) {
    const shift = new Vector3(...offset);
    const ends = [roots[start], roots[end]].map((root) => root.clone().add(shift));
    this.#capsule(this.group, ...ends, radius, material.palm);
  }

  #capsule(parent, start, end, radius, material) {
    const length = start.distanceTo(end);
    const geometry = length ? new CapsuleGeometry(radius, length, 8, 20) : new SphereGeometry(radius, 20, 14);
    const mesh = new Mesh(geometry, material);
    mesh.position.copy(start).add(end).divideScalar(2);
    if (length) mesh.quaternion.setFromUnitVectors(new Vector3(0, 1, 0), end.clone().sub(start).normalize());
    parent.add(mesh);
    this.#shapesOf.push(mesh);
  }

  /** Adds printed parts to the links that they belong to. */
  addMeshes(meshes) {
    this.parts = meshes.flatMap(({ links, geometry, material }) =>
      links.map((link) => {
        const mesh = new Mesh(geometry, material);
        this.links[link].add(mesh);
        return mesh;
      }));
  }

  /** Shows the printed parts, where there are any, or the contact shapes. */
  showParts(parts) {
    const printed = Boolean(parts) && this.parts !== undefined; // three.js draws what is not exactly false
    this.shown.forEach((mesh) => (mesh.visible = !printed));
    this.parts?.forEach((mesh) => (mesh.visible = printed));
  }

  setJoints(angles) {
    this.joints.forEach(({ group, axis }, i) => (group.rotation[axis] = angles[i]));
  }

  /** Joint angles [rad] as the scene has them. */
  readJoints() {
    return this.joints.map(({ group, axis }) => group.rotation[axis]);
  }

  dispose() {
    this.shown.forEach((mesh) => mesh.geometry.dispose());
  }
}
