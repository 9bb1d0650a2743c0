package voqcal.spy;

import java.awt.Color;
import java.awt.Graphics;
import java.awt.Graphics2D;
import java.awt.RenderingHints;
import java.awt.geom.Path2D;
import java.io.IOException;
import java.nio.ByteBuffer;
import java.nio.ByteOrder;
import lcm.lcm.LCMDataInputStream;
import voqcal.lidar_board_t;
import voqcal.lidar_candidate_t;
import voqcal.pointcloud2_t;
import voqcal.pointfield_t;

/**
 * The newest sweep of a channel from above (lidar frame: x up, y left, the sensor in the middle), with
 * the outline and the points of the board that the lidar board detector found in it. The wheel zooms.
 */
class CloudView extends View {
  private static final int FLOAT32 = 7;
  private static final int FLOAT64 = 8;
  private static final double METRES_A_GRID_LINE = 1;

  private float[][] points = {};
  private long pointsUtime;
  private lidar_board_t board;
  private double halfWidthMetres = 6;

  CloudView(String channel) {
    super(channel, lidar_board_t.LCM_FINGERPRINT);
    setBackground(Color.BLACK);
    addMouseWheelListener(
        event -> {
          halfWidthMetres *= Math.pow(1.1, event.getPreciseWheelRotation());
          repaint();
        });
  }

  @Override
  void takeSensorMessage(LCMDataInputStream message) throws IOException {
    pointcloud2_t newest = new pointcloud2_t(message);
    float[][] decoded = decode(newest);
    synchronized (this) {
      points = decoded;
      pointsUtime = newest.utime;
    }
  }

  @Override
  void takeBoardMessage(LCMDataInputStream message) throws IOException {
    lidar_board_t newest = new lidar_board_t(message);
    synchronized (this) {
      board = newest;
    }
  }

  @Override
  protected synchronized void paintComponent(Graphics graphics) {
    super.paintComponent(graphics);
    Graphics2D canvas = (Graphics2D) graphics.create();
    drawGrid(canvas);
    for (float[] point : points) {
      if (Float.isNaN(point[0])) {
        continue;
      }
      // Floor blue, two metres above it red: 0.67 to 0 of the colour circle.
      float height = Math.max(0, Math.min(1, (point[2] + 1.2f) / 2));
      canvas.setColor(Color.getHSBColor(0.67f * (1 - height), 0.7f, 0.8f));
      canvas.fillRect(column(point[1]), row(point[0]), 1, 1);
    }
    if (board != null && board.utime == pointsUtime) {
      drawBoard(canvas);
    }
    canvas.dispose();
  }

  private double pixelsPerMetre() {
    return Math.min(getWidth(), getHeight()) / (2 * halfWidthMetres);
  }

  private int column(double yMetres) {
    return (int) Math.round(getWidth() / 2.0 - yMetres * pixelsPerMetre());
  }

  private int row(double xMetres) {
    return (int) Math.round(getHeight() / 2.0 - xMetres * pixelsPerMetre());
  }

  private void drawGrid(Graphics2D canvas) {
    int numLines = (int) (halfWidthMetres * getWidth() / getHeight() / METRES_A_GRID_LINE) + 1;
    for (int i = -numLines; i <= numLines; ++i) {
      canvas.setColor(i == 0 ? Color.GRAY : Color.DARK_GRAY);
      canvas.drawLine(0, row(i * METRES_A_GRID_LINE), getWidth(), row(i * METRES_A_GRID_LINE));
      canvas.drawLine(column(i * METRES_A_GRID_LINE), 0, column(i * METRES_A_GRID_LINE), getHeight());
    }
  }

  private void drawBoard(Graphics2D canvas) {
    canvas.setColor(Color.WHITE);
    if (!board.miss.isEmpty()) {
      canvas.drawString("no board: " + board.miss, 8, 18);
      return;
    }
    lidar_candidate_t best = board.candidates[0];
    for (float[] point : best.points) {
      canvas.fillRect(column(point[1]), row(point[0]), 2, 2);
    }
    canvas.setRenderingHint(RenderingHints.KEY_ANTIALIASING, RenderingHints.VALUE_ANTIALIAS_ON);
    Path2D outline = new Path2D.Double();
    for (int i = 0; i < 4; ++i) {
      double[] corner = best.pose.corners_m[i];
      if (i == 0) {
        outline.moveTo(column(corner[1]), row(corner[0]));
      } else {
        outline.lineTo(column(corner[1]), row(corner[0]));
      }
    }
    outline.closePath();
    canvas.setColor(Color.GREEN);
    canvas.draw(outline);
    double[] centre = best.pose.centre_m;
    canvas.drawString(
        String.format("%.2f %.2f %.2f m", centre[0], centre[1], centre[2]),
        column(centre[1]) + 12,
        row(centre[0]) - 12);
  }

  /** x, y and z of each point, metres. */
  private static float[][] decode(pointcloud2_t message) throws IOException {
    ByteBuffer bytes = ByteBuffer.wrap(message.data);
    bytes.order(message.is_bigendian ? ByteOrder.BIG_ENDIAN : ByteOrder.LITTLE_ENDIAN);
    pointfield_t[] axes = {field(message, "x"), field(message, "y"), field(message, "z")};
    float[][] points = new float[message.width * message.height][3];
    for (int i = 0; i < points.length; ++i) {
      int at = i / message.width * message.row_step + i % message.width * message.point_step;
      for (int axis = 0; axis < 3; ++axis) {
        int offset = at + axes[axis].offset;
        points[i][axis] =
            axes[axis].datatype == FLOAT32
                ? bytes.getFloat(offset)
                : (float) bytes.getDouble(offset);
      }
    }
    return points;
  }

  private static pointfield_t field(pointcloud2_t message, String name) throws IOException {
    for (pointfield_t field : message.fields) {
      if (field.name.equals(name) && (field.datatype == FLOAT32 || field.datatype == FLOAT64)) {
        return field;
      }
    }
    throw new IOException("points without a field " + name + " of floating point numbers");
  }
}
