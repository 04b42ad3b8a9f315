// SPDX-License-Identifier: Apache-2.0
// A square that an image covers, as OBJ and as DAE, and robots that are such squares.

import { writeFileSync } from 'node:fs';
import { join } from 'node:path';
import { crc32, deflateSync } from 'node:zlib';

const crc = crc32 ?? slowCrc32; // zlib.crc32 came with node 22

function slowCrc32(bytes) {
  let sum = 0xffffffff;
  for (const byte of bytes) {
    sum ^= byte;
    for (let k = 0; k < 8; ++k) sum = sum & 1 ? (sum >>> 1) ^ 0xedb88320 : sum >>> 1;
  }
  return (sum ^ 0xffffffff) >>> 0;
}

/** A PNG of true colours; `rows` of [r, g, b]. */
export function png(rows) {
  const chunk = (type, data) => {
    const body = Buffer.concat([Buffer.from(type, 'latin1'), data]);
    const out = Buffer.alloc(body.length + 8);
    out.writeUInt32BE(data.length, 0);
    body.copy(out, 4);
    out.writeUInt32BE(crc(body), out.length - 4);
    return out;
  };
  const head = Buffer.alloc(13);
  head.writeUInt32BE(rows[0].length, 0);
  head.writeUInt32BE(rows.length, 4);
  head.set([8, 2], 8); // bits, colour
  const pixels = Buffer.from(rows.flatMap((row) => [0, ...row.flat()]));
  return Buffer.concat([
    Buffer.from('\x89PNG\r\n\x1a\n', 'latin1'),
    chunk('IHDR', head),
    chunk('IDAT', deflateSync(pixels)),
    chunk('IEND', Buffer.alloc(0)),
  ]);
}

// A metre across, in the plane of y and z, seen from x.
const OBJ = `mtllib square.mtl
v 0 -0.5 -0.5
v 0 0.5 -0.5
v 0 0.5 0.5
v 0 -0.5 0.5
vt 0 0
vt 1 0
vt 1 1
vt 0 1
usemtl painted
f 1/1 2/2 3/3 4/4
`;
const MTL = 'newmtl painted\nKd 0.2 0.2 0.2\nmap_Kd painted.png\n';

const source = (id, names, numbers) => `<source id="${id}">
  <float_array id="${id}-array" count="${numbers.length}">${numbers.join(' ')}</float_array>
  <technique_common><accessor source="#${id}-array" count="${numbers.length / names.length}" stride="${names.length}">
  ${names.map((name) => `<param name="${name}" type="float"/>`).join('')}</accessor></technique_common></source>`;

const DAE = `<?xml version="1.0"?>
<COLLADA xmlns="http://www.collada.org/2005/11/COLLADASchema" version="1.4.1">
<asset><unit name="meter" meter="1"/><up_axis>Z_UP</up_axis></asset>
<library_images><image id="image"><init_from>painted.png</init_from></image></library_images>
<library_effects><effect id="effect"><profile_COMMON>
  <newparam sid="surface"><surface type="2D"><init_from>image</init_from></surface></newparam>
  <newparam sid="sampler"><sampler2D><source>surface</source></sampler2D></newparam>
  <technique sid="common"><lambert><diffuse><texture texture="sampler" texcoord="UV"/></diffuse></lambert></technique>
</profile_COMMON></effect></library_effects>
<library_materials><material id="painted" name="painted"><instance_effect url="#effect"/></material></library_materials>
<library_geometries><geometry id="square"><mesh>
${source('places', ['X', 'Y', 'Z'], [0, -0.5, -0.5, 0, 0.5, -0.5, 0, 0.5, 0.5, 0, -0.5, 0.5])}
${source('uv', ['S', 'T'], [0, 0, 1, 0, 1, 1, 0, 1])}
<vertices id="corners"><input semantic="POSITION" source="#places"/></vertices>
<triangles material="painted" count="2">
  <input semantic="VERTEX" source="#corners" offset="0"/>
  <input semantic="TEXCOORD" source="#uv" offset="1" set="0"/>
  <p>0 0 1 1 2 2 0 0 2 2 3 3</p></triangles></mesh></geometry></library_geometries>
<library_visual_scenes><visual_scene id="scene"><node id="node"><instance_geometry url="#square">
  <bind_material><technique_common><instance_material symbol="painted" target="#painted">
  <bind_vertex_input semantic="UV" input_semantic="TEXCOORD" input_set="0"/></instance_material></technique_common></bind_material>
</instance_geometry></node></visual_scene></library_visual_scenes>
<scene><instance_visual_scene url="#scene"/></scene>
</COLLADA>
`;

export const QUARTERS = {
  'top left': [220, 40, 30],
  'top right': [30, 170, 60],
  'bottom left': [40, 70, 220],
  'bottom right': [230, 200, 30],
};

/** Writes square_obj.urdf and square_dae.urdf, and what they need, to a folder. */
export function writeSquares(folder) {
  const [a, b, c, d] = Object.values(QUARTERS);
  const half = (left, right) => [...Array(8).fill(left), ...Array(8).fill(right)];
  const rows = [...Array(8).fill(half(a, b)), ...Array(8).fill(half(c, d))];
  const files = {
    'painted.png': png(rows),
    'square.mtl': MTL,
    'square.obj': OBJ,
    'square.dae': DAE,
  };
  for (const kind of ['obj', 'dae'])
    files[`square_${kind}.urdf`] = `<robot name="square_${kind}"><link name="square">
  <inertial><mass value="1"/><inertia ixx="1" iyy="1" izz="1" ixy="0" ixz="0" iyz="0"/></inertial>
  <visual><geometry><mesh filename="square.${kind}"/></geometry></visual></link></robot>\n`;
  for (const [name, bytes] of Object.entries(files)) writeFileSync(join(folder, name), bytes);
}
