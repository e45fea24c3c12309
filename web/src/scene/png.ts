/** A picture as PNG. */
import { download } from "../dom";
import type { Store } from "../store";
import { texts } from "../texts";

const SCALE = 2;

/** Draws an SVG at twice its size. Rejects where the browser cannot. */
async function pngOf(svg: string): Promise<Blob> {
  const address = URL.createObjectURL(new Blob([svg], { type: "image/svg+xml" }));
  try {
    const image = new Image();
    image.src = address;
    await image.decode();
    const canvas = document.createElement("canvas");
    canvas.width = image.naturalWidth * SCALE;
    canvas.height = image.naturalHeight * SCALE;
    const context = canvas.getContext("2d");
    if (context === null) {
      throw new Error("no canvas");
    }
    context.fillStyle = "#ffffff";
    context.fillRect(0, 0, canvas.width, canvas.height);
    context.drawImage(image, 0, 0, canvas.width, canvas.height);
    return await new Promise((resolve, reject) => canvas.toBlob((blob) => (blob ? resolve(blob) : reject(new Error("no PNG")))));
  } finally {
    URL.revokeObjectURL(address);
  }
}

/** Gives an SVG to the user as a PNG called `name`, or says that it cannot. */
export function downloadPng(store: Store, name: string, svg: string): void {
  pngOf(svg).then(
    (picture) => download(name, picture, "image/png"),
    () => store.fail(texts.page.scene.pngFailed),
  );
}
