import { defineConfig } from "vite";

// Paths are relative, so that the built folder works under any path of a static server.
export default defineConfig({
  base: "./",
  worker: { format: "es" },
  build: { target: "es2022" },
});
