/**
 * The scene in the address of the page: `#s=` and its TOML, deflated, in base64url; `#o=` of a scene with an own record of the name of the
 * page's, which is not to be taken for it.
 */

const PREFIX = "#s=";
/** As long as the other. */
const OWN_PREFIX = "#o=";
/** Longest scene that is put into an address, and that is unpacked from one. */
const MOST_CHARACTERS = 200_000;

/** The fragment of a scene, with an own record for the page's if `hasOwn`; null where the scene is too long. */
export async function pack(text: string, hasOwn = false): Promise<string | null> {
  if (text.length > MOST_CHARACTERS) {
    return null;
  }
  const packed = new Blob([text]).stream().pipeThrough(new CompressionStream("deflate-raw"));
  const bytes = new Uint8Array(await new Response(packed).arrayBuffer());
  // Small pieces: every byte becomes an argument of the call.
  let binary = "";
  for (let i = 0; i < bytes.length; i += 4096) {
    binary += String.fromCharCode(...bytes.subarray(i, i + 4096));
  }
  return (hasOwn ? OWN_PREFIX : PREFIX) + btoa(binary).replaceAll("+", "-").replaceAll("/", "_").replaceAll("=", "");
}

/** Whether a fragment claims to be a scene. */
export function isPacked(fragment: string): boolean {
  return fragment.startsWith(PREFIX) || isOwn(fragment);
}

/** Whether the scene of a fragment has an own record for the page's. */
export function isOwn(fragment: string): boolean {
  return fragment.startsWith(OWN_PREFIX);
}

/** The scene of a fragment. Rejects where it is none: cut off, changed, or of a size that no scene has. */
export async function unpack(fragment: string): Promise<string> {
  const binary = atob(fragment.slice(PREFIX.length).replaceAll("-", "+").replaceAll("_", "/"));
  const bytes = Uint8Array.from(binary, (character) => character.charCodeAt(0));
  const reader = new Blob([bytes]).stream().pipeThrough(new DecompressionStream("deflate-raw")).getReader();
  const decoder = new TextDecoder("utf-8", { fatal: true });
  let text = "";
  for (let part = await reader.read(); !part.done; part = await reader.read()) {
    text += decoder.decode(part.value, { stream: true });
    if (text.length > MOST_CHARACTERS) {
      await reader.cancel();
      throw new RangeError("too long");
    }
  }
  text += decoder.decode();
  if (text.trim() === "") {
    throw new RangeError("empty");
  }
  return text;
}
